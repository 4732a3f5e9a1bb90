#include "server/experiments/sweep_plan.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "core/cancel.hpp"
#include "core/measure/sha256.hpp"
#include "core/text/number_text.hpp"
#include "evaluation/statistics/wilson.hpp"
#include "server/experiments/keys/plain_numbers.hpp"
#include "server/experiments/keys/result_key.hpp"
#include "server/experiments/pictures/picture_key.hpp"
#include "vo_bridges/process/child/program.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;

/// Of a flight for several estimators; a name of a folder.
std::string flight_id(const std::vector<std::string>& keys) {
  constexpr std::size_t kDigits = 20;
  std::string text;
  for (const std::string& key : keys) text += key;
  return sha256_hex({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()})
      .substr(0, kDigits);
}

/// Keeps the estimators with these indices, in ascending order.
void keep_estimators(Scenario& scenario, const std::vector<std::size_t>& kept) {
  std::vector<EstimatorSpec> specs;
  Json documents = Json::array();
  for (const std::size_t i : kept) {
    specs.push_back(std::move(scenario.estimators[i]));
    documents.push_back(scenario.resolved.at("estimators").at(i));
  }
  scenario.estimators = std::move(specs);
  scenario.resolved["estimators"] = std::move(documents);
}

/// What is wrong in the cells of a sweep: each different error once.
class CellFaults {
 public:
  /// @param error  as of scenario_of
  void add(const SweepCell& cell, const Error& error) {
    const std::string text = cell_text(cell.values);
    const std::string context = text + ": ";
    const bool named = !text.empty() && error.message.starts_with(context);
    const std::string message = named ? error.message.substr(context.size()) : error.message;
    if (error.code == ErrorCode::kForbidden) code_ = ErrorCode::kForbidden;
    const auto known = std::find_if(faults_.begin(), faults_.end(), [&](const Fault& fault) {
      return fault.message == message;
    });
    if (known == faults_.end()) {
      faults_.push_back({message, text, 1});
    } else {
      ++known->cells;
    }
  }
  [[nodiscard]] bool empty() const { return faults_.empty(); }
  [[nodiscard]] Error error() const {
    std::string text;
    for (std::size_t i = 0; i < std::min(faults_.size(), kMostMessages); ++i) {
      text += (i > 0 ? "\n" : "") + words_of(faults_[i]);
    }
    if (faults_.size() > kMostMessages) {
      text += "\nand " + counted(faults_.size() - kMostMessages, "other error");
    }
    return {code_, text};
  }

 private:
  struct Fault {
    std::string message;
    std::string cell;  ///< the first one that has it, in words
    std::size_t cells = 0;
  };
  static constexpr std::size_t kMostMessages = 10;

  static std::string words_of(const Fault& fault) {
    if (fault.cell.empty()) return fault.message;
    if (fault.cells == 1) return fault.cell + ": " + fault.message;
    return fault.message + " (in " + std::to_string(fault.cells) + " cells; the first is " +
           fault.cell + ")";
  }

  std::vector<Fault> faults_;
  ErrorCode code_ = ErrorCode::kInvalidArgument;
};

}  // namespace

bool has_enough(const RepeatRule& rule, int successes, int flights) {
  if (flights >= rule.most) return true;
  if (!rule.half_width || flights == 0) return false;
  return evaluation::wilson_interval(successes, flights).half_width() <= *rule.half_width;
}

Result<SweepPlan> SweepPlan::make(const Sweep& sweep,
                                  std::vector<SweepCell> cells,
                                  const std::atomic<bool>* cancel) {
  SweepPlan plan(sweep, std::move(cells));
  CellFaults errors;
  for (std::size_t i = 0; i < plan.cells_.size(); ++i) {
    if (is_cancelled(cancel)) return Error{ErrorCode::kCancelled, "cancelled"};
    const Result<Scenario> scenario = scenario_of(sweep, plan.cells_[i], 0);
    if (!scenario) {
      errors.add(plan.cells_[i], scenario.error());
      continue;
    }
    if (scenario->is_live()) {
      return Error{ErrorCode::kInvalidArgument,
                   sweep.scenario_file.string() + ": flight: must not be live in a sweep"};
    }
    // What the first repeat cannot show: neither its world nor its start is changed.
    if (sweep.repeats.most > 1 && (sweep.repeats.vary_world || sweep.repeats.vary_start_s > 0.0)) {
      const Result<Scenario> second = scenario_of(sweep, plan.cells_[i], 1);
      if (!second) {
        errors.add(plan.cells_[i], second.error());
        continue;
      }
    }
    plan.states_[i].pictures = picture_key(*scenario);
    ++plan.cells_with_pictures_[plan.states_[i].pictures];
    for (const EstimatorSpec& estimator : scenario->estimators) plan.note_estimator(estimator);
  }
  if (!errors.empty()) return errors.error();
  if (plan.estimators_.empty()) {
    return Error{ErrorCode::kInvalidArgument, "estimators: must have at least one"};
  }
  return plan;
}

void SweepPlan::note_estimator(const EstimatorSpec& estimator) {
  const auto add = [](std::vector<std::string>& texts, const std::string& text) {
    if (std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(text);
  };
  add(estimators_, estimator.name);
  if (estimator.command.empty()) return;
  const auto program = process::find_program(estimator.command.front());
  if (!program) {
    add(absent_programs_, "estimator " + estimator.name + ": " + program.error().message);
  }
}

bool SweepPlan::is_flying(const std::string& key) const {
  const auto found = flying_.find(key);
  return found != flying_.end() && found->second;
}

bool SweepPlan::awaits_result(const State& state) const {
  return std::any_of(state.keys.begin(), state.keys.end(), [&](const auto& estimator) {
    return is_flying(estimator.second.back());
  });
}

std::optional<std::size_t> SweepPlan::next_cell() const {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const State& state = states_[i];
    if (state.finished || (best && state.next_repeat >= states_[*best].next_repeat)) continue;
    if (!sweep_->repeats.half_width || !awaits_result(state)) best = i;
  }
  return best;
}

bool SweepPlan::is_open(std::size_t cell,
                        const std::string& estimator,
                        const SweepResults& results) const {
  int successes = 0;
  int flights = 0;
  for (const SweepResult* result : results_of(cell, estimator, results)) {
    if (!result->completed()) continue;
    ++flights;
    successes += result->outcome == evaluation::Outcome::kCompleted ? 1 : 0;
  }
  return states_[cell].next_repeat < sweep_->repeats.most &&
         !has_enough(sweep_->repeats, successes, flights);
}

Result<std::optional<DueFlight>> SweepPlan::flight_of(std::size_t cell,
                                                      const SweepResults& results) {
  State& state = states_[cell];
  Result<Scenario> scenario = scenario_of(*sweep_, cells_[cell], state.next_repeat);
  if (!scenario) return scenario.error();
  const std::string flight = flight_key(*scenario);
  DueFlight due{cell, state.next_repeat, {}, {}, {}};
  std::vector<std::size_t> kept;
  bool any_open = false;
  for (std::size_t i = 0; i < scenario->estimators.size(); ++i) {
    const std::string& name = scenario->estimators[i].name;
    if (!is_open(cell, name, results)) continue;
    any_open = true;
    std::string key = result_key(flight, scenario->resolved.at("estimators").at(i));
    state.keys[name].push_back(key);
    const SweepResult* known = results.find(key);
    if ((known != nullptr && known->completed()) || flying_.contains(key)) {
      shared_.push_back({cell, state.next_repeat, std::move(key)});
      continue;
    }
    kept.push_back(i);
    due.keys.push_back(std::move(key));
  }
  state.finished = !any_open;
  if (any_open) ++state.next_repeat;
  if (kept.empty()) return std::optional<DueFlight>();
  keep_estimators(*scenario, kept);
  due.scenario = std::move(*scenario);
  due.key = flight_id(due.keys);
  for (const std::string& key : due.keys) flying_[key] = true;
  ++state.flying;
  return std::optional<DueFlight>(std::move(due));
}

Result<std::optional<DueFlight>> SweepPlan::next(const SweepResults& results,
                                                 const std::atomic<bool>* cancel) {
  while (const std::optional<std::size_t> cell = next_cell()) {
    if (is_cancelled(cancel)) break;
    Result<std::optional<DueFlight>> flight = flight_of(*cell, results);
    if (!flight || *flight) return flight;
  }
  return std::optional<DueFlight>();
}

bool SweepPlan::shares_pictures(const DueFlight& flight) const {
  const std::string& first = states_[flight.cell].pictures;
  const auto cells = cells_with_pictures_.find(first);
  if (cells != cells_with_pictures_.end() && cells->second > 1) return true;
  if (sweep_->repeats.most < 2) return false;
  if (flight.repeat > 0) return picture_key(flight.scenario) == first;
  const Result<Scenario> second = scenario_of(*sweep_, cells_[flight.cell], 1);
  return second && picture_key(*second) == first;
}

void SweepPlan::over(const DueFlight& flight) {
  --states_[flight.cell].flying;
  for (const std::string& key : flight.keys) flying_[key] = false;
}

std::vector<SweepResult> SweepPlan::take_shared(const SweepResults& results) {
  std::vector<SweepResult> taken;
  std::vector<Shared> flying;
  for (Shared& shared : shared_) {
    if (is_flying(shared.key)) {
      flying.push_back(std::move(shared));
      continue;
    }
    const SweepResult* known = results.find(shared.key);
    if (known == nullptr) continue;
    SweepResult own = *known;
    own.cell = cells_[shared.cell].values;
    own.repeat = shared.repeat;
    if (!results.has(own)) taken.push_back(std::move(own));
  }
  shared_ = std::move(flying);
  return taken;
}

std::vector<SweepResult> SweepPlan::surplus(const SweepResults& results) const {
  std::map<std::string, const State*> finished;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (!states_[i].finished) continue;
    finished[with_plain_numbers(cells_[i].values).dump()] = &states_[i];
  }
  std::vector<SweepResult> found;
  for (const SweepResult* result : results.newest()) {
    const auto state = finished.find(result->cell.dump());
    if (state == finished.end()) continue;
    const auto keys = state->second->keys.find(result->estimator);
    if (keys == state->second->keys.end()) continue;
    if (result->repeat >= static_cast<int>(keys->second.size())) found.push_back(*result);
  }
  return found;
}

std::size_t SweepPlan::most_flights() const {
  return cells_.size() * static_cast<std::size_t>(sweep_->repeats.most);
}

std::size_t SweepPlan::passed_flights() const {
  std::size_t passed = 0;
  for (const State& state : states_) {
    passed += static_cast<std::size_t>(state.finished ? sweep_->repeats.most
                                                      : state.next_repeat - state.flying);
  }
  return passed;
}

std::vector<const SweepResult*> SweepPlan::results_of(std::size_t cell,
                                                      const std::string& estimator,
                                                      const SweepResults& results) const {
  std::vector<const SweepResult*> found;
  const auto keys = states_[cell].keys.find(estimator);
  if (keys == states_[cell].keys.end()) return found;
  for (const std::string& key : keys->second) {
    if (const SweepResult* result = results.find(key)) found.push_back(result);
  }
  return found;
}

}  // namespace overfly::server::experiments
