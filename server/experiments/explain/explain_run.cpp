#include "server/experiments/explain/explain_run.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/text/number_text.hpp"
#include "server/experiments/explain/data_limit.hpp"
#include "server/experiments/explain/explained_run.hpp"
#include "server/experiments/flights/flight_files.hpp"
#include "server/record/run_lock.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using evaluation::Outcome;
using Causes = std::vector<Cause>;

/// Flights that are left for the tests of what was found.
constexpr std::size_t kReservedFlights = 4;
constexpr int kMostMarginFlights = 3;
std::vector<CauseChange> without_all(const Causes& causes, const Causes& but = {}) {
  std::vector<CauseChange> changes;
  for (const Cause cause : causes) {
    if (!holds(but, cause)) changes.push_back(without(cause));
  }
  return changes;
}

bool has_survived(const Reflight* flight) { return flight != nullptr && flight->survived; }
bool has_failed(const Reflight* flight) { return flight != nullptr && flight->failed(); }

std::string share_name(Cause cause, double share) {
  char text[64];
  std::snprintf(text, sizeof text, "with %.3g %% of ", 100.0 * share);
  return text + words_for(cause);
}

class Explainer {
 public:
  Explainer(const ExplainedRun& run, const ExplainOptions& options, Explanation explanation)
      : run_(run),
        options_(options),
        flights_(options.flights, run.folder),
        result_(std::move(explanation)) {}

  Result<Explanation> explain() {
    using Step = Status (Explainer::*)();
    for (const Step step : {&Explainer::find_part,
                            &Explainer::take_away_each,
                            &Explainer::change_each,
                            &Explainer::change_those_left_out,
                            &Explainer::keep_each,
                            &Explainer::take_away_pairs,
                            &Explainer::confirm,
                            &Explainer::find_margin}) {
      if (Status status = (this->*step)(); !status) return status.error();
      if (!result_.reproduced) break;
    }
    // With the same imagery it was survived.
    const bool survives_somehow = has_survived(calm_) || !result_.pair.empty();
    if (control_ != nullptr && (!survives_somehow || holds(result_.necessary, Cause::kTexture))) {
      result_.data_reason = data_limit(*control_, result_.necessary, result_.sufficient);
      result_.data_limited = !result_.data_reason.empty();
    }
    result_.flights.assign(flights_.flights().begin(), flights_.flights().end());
    return std::move(result_);
  }

 private:
  using Flown = Result<std::vector<const Reflight*>>;

  [[nodiscard]] Flown fly(const std::vector<PlannedReflight>& plan) {
    return flights_.fly(document_, result_.part, plan);
  }

  Status find_part() {
    for (const CriticalPart& part : critical_parts(run_.score, run_.duration_s)) {
      document_ = part_document(run_.document, run_.folder, run_.estimator, part);
      result_.part = part;
      const Flown flown = fly({{"as it was", {}, false}});
      if (!flown) return flown.error();
      const Reflight* flight = flown->front();
      result_.parts_left_out = flight == nullptr;
      if (flight == nullptr) break;
      if (!flight->error.empty()) {
        return Error{ErrorCode::kInternal, "cannot be flown again: " + flight->error};
      }
      // Where the estimator needs longer to initialise than the part allows, the failure of the run
      // was not seen: that takes a longer part.
      const bool other_failure =
          failed_to_start(flight->score.outcome) && !failed_to_start(run_.score.outcome);
      if (has_failed(flight) && !other_failure) {
        control_ = flight;
        result_.reproduced = true;
        break;
      }
    }
    return {};
  }

  [[nodiscard]] bool is_wanted(Cause cause) const {
    return options_.causes.empty() || holds(options_.causes, cause);
  }

  void note_untried(Cause cause, const std::string& reason) {
    const bool known = std::any_of(result_.untried.begin(),
                                   result_.untried.end(),
                                   [&](const UntriedCause& each) { return each.cause == cause; });
    if (!known) result_.untried.push_back({cause, reason});
  }

  /// Wanted causes that can be changed, the most suspicious first.
  [[nodiscard]] Causes changeable(bool disturbances) {
    Causes causes;
    for (const Cause cause : all_causes()) {
      if (!is_wanted(cause) || is_disturbance(cause) != disturbances) continue;
      if (const auto reason = why_unchangeable(document_, cause)) {
        note_untried(cause, *reason);
      } else {
        causes.push_back(cause);
      }
    }
    const double instant_s = run_.score.outcome_time_s.value_or(0.0) - result_.part.from_s;
    std::stable_sort(causes.begin(), causes.end(), [&](Cause a, Cause b) {
      return suspicion(document_, a, instant_s) > suspicion(document_, b, instant_s);
    });
    return causes;
  }

  /// The first causes that fit the flights left; the others are noted as not tried.
  [[nodiscard]] Causes affordable(Causes causes, std::size_t other_flights) {
    const std::size_t reserved = kReservedFlights + other_flights;
    const std::size_t most =
        std::max<std::size_t>(1, flights_.left() - std::min(flights_.left(), reserved));
    while (causes.size() > most) {
      left_out_.push_back(causes.back());
      result_.untried.push_back(
          {causes.back(),
           "beyond the limit of " + counted(options_.flights.most_flights, "flight")});
      causes.pop_back();
    }
    return causes;
  }

  /// Flies without each cause and notes those without which the estimator survives.
  Status fly_without(const Causes& causes) {
    std::vector<PlannedReflight> plan;
    for (const Cause cause : causes) {
      plan.push_back({words_without(cause), {without(cause)}, false});
    }
    const Flown flown = fly(plan);
    if (!flown) return flown.error();
    for (std::size_t i = 0; i < causes.size(); ++i) {
      if ((*flown)[i] == nullptr) continue;
      tried_.push_back(causes[i]);
      if (has_survived((*flown)[i])) result_.necessary.push_back(causes[i]);
    }
    return {};
  }

  Status take_away_each() {
    disturbances_ = changeable(true);
    for (const Cause cause : all_causes()) {
      if (!is_wanted(cause) && is_disturbance(cause) && !why_unchangeable(document_, cause)) {
        result_.not_changed.push_back(cause);
      }
    }
    if (disturbances_.empty()) {
      calm_ = control_;
      return {};
    }
    const char* const name =
        result_.not_changed.empty() ? "without any disturbance" : "without all causes to be tried";
    const Flown flown = fly({{name, without_all(disturbances_), false}});
    if (!flown) return flown.error();
    calm_ = flown->front();
    return fly_without(affordable(disturbances_, 0));
  }

  /// Changes texture, features, roll rate and start, if that is what is left.
  Status change_each() {
    const bool named = !options_.causes.empty();
    if (!named && (!result_.necessary.empty() || has_survived(calm_))) return {};
    return fly_without(affordable(changeable(false), 0));
  }

  /// Where nothing has been found, no flight needs to be kept to confirm it.
  Status change_those_left_out() {
    if (!result_.necessary.empty() || has_survived(calm_)) return {};
    Causes causes(left_out_.rbegin(), left_out_.rend());
    std::erase_if(causes, is_disturbance);
    if (causes.size() > flights_.left()) causes.resize(flights_.left());
    std::erase_if(result_.untried,
                  [&](const UntriedCause& untried) { return holds(causes, untried.cause); });
    return fly_without(causes);
  }

  /// Causes that may be enough by themselves.
  [[nodiscard]] Causes candidates() const {
    if (!result_.necessary.empty()) return result_.necessary;
    return has_survived(calm_) ? disturbances_ : Causes{};
  }

  /// Flies with one cause as it was and all others taken away.
  Status keep_each() {
    if (!result_.not_changed.empty()) return {};
    const Causes kept = affordable_kept(candidates());
    Causes others = disturbances_;
    for (const Cause cause : result_.necessary) {
      if (!holds(others, cause)) others.push_back(cause);
    }
    std::vector<PlannedReflight> plan;
    for (const Cause cause : kept) {
      plan.push_back({"with only " + words_for(cause), without_all(others, {cause}), false});
    }
    const Flown flown = fly(plan);
    if (!flown) return flown.error();
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const Reflight* flight = (*flown)[i];
      if (has_failed(flight) || has_survived(flight)) result_.sufficiency_tested.push_back(kept[i]);
      if (has_failed(flight)) result_.sufficient.push_back(kept[i]);
    }
    const bool all_tested = result_.sufficiency_tested.size() == result_.necessary.size();
    if (result_.sufficient.empty() && result_.necessary.size() > 1 && all_tested) {
      result_.together = result_.necessary;
    }
    return {};
  }

  [[nodiscard]] Causes affordable_kept(Causes causes) const {
    if (causes.size() > flights_.left()) causes.resize(flights_.left());
    return causes;
  }

  /// Where no single cause has to go, two may have to.
  Status take_away_pairs() {
    if (!result_.necessary.empty()) return {};
    Causes causes = result_.sufficient.size() > 1 ? result_.sufficient : tried_;
    // Taking away all disturbances was not enough.
    if (has_failed(calm_)) std::erase_if(causes, is_disturbance);
    for (std::size_t last = 1; last < causes.size(); ++last) {
      for (std::size_t first = 0; first < last && flights_.left() > 0; ++first) {
        const Causes pair = {causes[first], causes[last]};
        const Flown flown = fly({{words_without(pair[0]) + " and " + words_without(pair[1]),
                                  without_all(pair),
                                  false}});
        if (!flown) return flown.error();
        if (!has_survived(flown->front())) continue;
        result_.pair = pair;
        return {};
      }
    }
    return {};
  }

  /// Flies what was found again with other random numbers, as far as flights are left.
  Status confirm() {
    Causes found = result_.necessary;
    if (found.empty() || flights_.left() < 2) return {};
    if (found.size() > flights_.left() - 1) found.resize(flights_.left() - 1);
    std::vector<PlannedReflight> plan = {{"as it was, other random numbers", {}, true}};
    for (const Cause cause : found) {
      plan.push_back({words_without(cause) + ", other random numbers", {without(cause)}, true});
    }
    const Flown flown = fly(plan);
    if (!flown) return flown.error();
    const Reflight* const control = flown->front();
    if (!has_failed(control) && !has_survived(control)) return {};  // it has no result
    result_.reproduced_with_other_seed = has_failed(control);
    if (!*result_.reproduced_with_other_seed) return {};
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (has_failed((*flown)[i + 1])) withdraw(found[i]);
      if (has_survived((*flown)[i + 1])) result_.confirmed.push_back(found[i]);
    }
    if (result_.withdrawn.empty() || !result_.necessary.empty()) return {};
    return change_with_other_seed();
  }

  /// A cause that was found by chance.
  void withdraw(Cause cause) {
    std::erase(result_.necessary, cause);
    std::erase(result_.sufficient, cause);
    std::erase(result_.sufficiency_tested, cause);
    result_.together.clear();
    result_.withdrawn.push_back(cause);
  }

  /// Changes what every flight has, with the random numbers with which no disturbance explains the
  /// failure.
  Status change_with_other_seed() {
    Causes causes = changeable(false);
    if (causes.size() > flights_.left()) causes.resize(flights_.left());
    std::vector<PlannedReflight> plan;
    for (const Cause cause : causes) {
      plan.push_back({words_without(cause) + ", other random numbers", {without(cause)}, true});
    }
    const Flown flown = fly(plan);
    if (!flown) return flown.error();
    for (std::size_t i = 0; i < causes.size(); ++i) {
      if (!has_survived((*flown)[i])) continue;
      result_.necessary.push_back(causes[i]);
      result_.confirmed.push_back(causes[i]);
    }
    has_first_seed_causes_ = false;
    return {};
  }

  Status find_margin() {
    if (!has_first_seed_causes_) return {};
    const Causes& causes = result_.necessary.empty() ? result_.sufficient : result_.necessary;
    const auto scaled = std::find_if(causes.begin(), causes.end(), [&](Cause cause) {
      return holds(result_.necessary, cause) && can_scale(document_, cause);
    });
    if (scaled == causes.end()) return {};
    CauseMargin margin{*scaled, without(*scaled).share, 1.0};
    for (int flight = 0; flight < kMostMarginFlights && flights_.left() > 0; ++flight) {
      const double share = (margin.survives_share + margin.fails_share) / 2.0;
      const Flown flown = fly({{share_name(*scaled, share), {{*scaled, share}}, false}});
      if (!flown && flown.error().code == ErrorCode::kInvalidArgument) break;  // beyond a limit
      if (!flown) return flown.error();
      const Reflight* made = flown->front();
      if (!has_survived(made) && !has_failed(made)) break;
      (has_survived(made) ? margin.survives_share : margin.fails_share) = share;
    }
    result_.margin = margin;
    return {};
  }

  const ExplainedRun& run_;
  const ExplainOptions& options_;
  Reflights flights_;
  Explanation result_;
  Json document_;  ///< flies the critical part
  const Reflight* control_ = nullptr;
  const Reflight* calm_ = nullptr;     ///< without any disturbance
  bool has_first_seed_causes_ = true;  ///< false: those found were all withdrawn
  Causes disturbances_;
  Causes tried_;
  Causes left_out_;  ///< not tried because of the limit, the least suspicious first
};

}  // namespace

Result<Explanation> explain_run(const fs::path& run_folder, const ExplainOptions& options) {
  const Result<ExplainedRun> run =
      read_explained_run(run_folder, options.estimator, options.flights.sources);
  if (!run) return run.error();
  Explanation explanation;
  explanation.run = run->id;
  explanation.title = run->title;
  explanation.estimator = run->estimator_name;
  explanation.score = run->score;
  explanation.succeeded = run->score.outcome == Outcome::kCompleted;
  if (explanation.succeeded) return explanation;
  if (Status status = FlightFiles(options.flights.folder).create(); !status) return status.error();
  const Result<RunLock> lock = RunLock::take(options.flights.folder);
  if (!lock) return lock.error();
  return Explainer(*run, options, std::move(explanation)).explain();
}

}  // namespace overfly::server::experiments
