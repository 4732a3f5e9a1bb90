#include "server/experiments/studies/prepare_study.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

#include "core/cancel.hpp"
#include "core/text/number_text.hpp"
#include "server/experiments/explain/cause.hpp"
#include "server/experiments/hunt/hunt_document.hpp"
#include "server/record/run_folder.hpp"
#include "server/scenario/document/scenario_file.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Error bad_study(const std::string& text) { return {ErrorCode::kInvalidArgument, text}; }

/// "field = value: must be one of a, b"
Error not_one_of(const std::string& field,
                 const std::string& value,
                 const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return bad_study(field + " = " + value.substr(0, 100) + ": must be one of " + list);
}

class Preparation {
 public:
  Preparation(RunManager& runs,
              const StudyFolder& folder,
              StudyRefusal& refusal,
              const std::atomic<bool>* cancel)
      : runs_(runs), folder_(folder), refusal_(refusal), cancel_(cancel) {}

  Result<StudyRecord> prepare(const StudyRequest& request) {
    record_.kind = request.kind();
    record_.jobs = request.jobs;
    record_.created_utc = utc_text(utc_now_ns());
    const Status prepared =
        std::visit([this](const auto& asks) { return add(asks); }, request.asks);
    if (!prepared) return prepared.error();
    if (Status status = folder_.write(record_); !status) return status.error();
    return std::move(record_);
  }

  /// Commands, addresses and memory of a scenario that was read already.
  Status check(const Scenario& scenario) {
    if (Status allowed = runs_.library().reach_check()(scenario); !allowed) return allowed;
    return check_memory(scenario);
  }

 private:
  Status check_memory(const Scenario& scenario) {
    Status fits = runs_.check_memory(scenario);
    if (!fits) refusal_ = StudyRefusal::kMemory;
    const RunMemory memory = memory_of(scenario);
    record_.memory.images_bytes = std::max(record_.memory.images_bytes, memory.images_bytes);
    record_.memory.caches_bytes = std::max(record_.memory.caches_bytes, memory.caches_bytes);
    return fits;
  }

  void add_option(const char* name, const std::string& value) {
    if (value.empty()) return;
    record_.options.insert(record_.options.end(), {name, value});
  }

  Status add(const ExplainRequest& asks) {
    const Result<RunInfo> info = runs_.run(asks.run);
    if (!info) return info.error();
    if (info->status != RunStatus::kCompleted) {
      return Error{
          ErrorCode::kConflict,
          "run \"" + asks.run + "\": status = " + to_string(info->status) + ": must be completed"};
    }
    if (Status status = choose_failed(*info, asks.estimator); !status) return status;
    for (const std::string& cause : asks.causes) {
      if (!cause_from(cause)) return not_one_of("causes", cause, cause_names());
    }
    const Result<Scenario> scenario = runs_.scenario_of(asks.run);
    if (!scenario) return scenario.error();
    if (Status status = check(*scenario); !status) return status;
    record_.subject = asks.run;
    record_.title =
        "Why " + record_.estimator + " failed: " + title_of(info->title, info->scenario);
    add_option("--estimator", record_.estimator);
    std::string causes;
    for (const std::string& cause : asks.causes) causes += (causes.empty() ? "" : ",") + cause;
    add_option("--causes", causes);
    add_option("--flights", std::to_string(asks.flights));
    return {};
  }

  static std::vector<std::string> cause_names() {
    std::vector<std::string> names;
    for (const Cause cause : all_causes()) names.emplace_back(to_string(cause));
    return names;
  }

  static std::string title_of(const std::string& title, const std::string& name) {
    return title.empty() ? name : title;
  }

  /// The wanted estimator, or the first one that failed.
  Status choose_failed(const RunInfo& info, const std::string& wanted) {
    std::vector<std::string> names;
    for (const EstimatorResult& result : info.results) {
      names.push_back(result.estimator);
      const bool failed = result.outcome != evaluation::Outcome::kCompleted;
      if (!wanted.empty() && result.estimator == wanted && !failed) {
        return bad_study(
            "estimator = " + wanted +
            ": must have failed: its outcome is COMPLETED, there is nothing to explain");
      }
      if (failed && (wanted.empty() || result.estimator == wanted)) {
        record_.estimator = result.estimator;
        return {};
      }
    }
    if (names.empty()) return bad_study("run = " + info.id + ": must have a scored estimator");
    if (!wanted.empty()) return not_one_of("estimator", wanted, names);
    return bad_study("run = " + info.id +
                     ": must have an estimator that failed: all are COMPLETED, there is nothing to "
                     "explain");
  }

  /// The scenario of a prediction or a hunt, checked; also written as input.
  Result<Scenario> read(const StudyScenario& asks) {
    const ScenarioLibrary& library = runs_.library();
    Result<Scenario> scenario = asks.document ? library.read_to_fly(*asks.document)
                                              : library.load_to_fly(asks.name, asks.overrides);
    if (!scenario) return scenario.error();
    if (scenario->is_live()) {
      return bad_study("flight = a live vehicle: must be known before it is flown");
    }
    if (Status status = check_memory(*scenario); !status) return status.error();
    record_.subject = scenario->name;
    Status written = folder_.write_input(folder_.scenario_file(), scenario->resolved);
    if (!written) return written.error();
    return scenario;
  }

  Status add(const PredictRequest& asks) {
    const Result<Scenario> scenario = read(asks.scenario);
    if (!scenario) return scenario.error();
    std::vector<std::string> cameras;
    for (const CameraSpec& camera : scenario->cameras) cameras.push_back(camera.name);
    if (!asks.camera.empty() &&
        std::find(cameras.begin(), cameras.end(), asks.camera) == cameras.end()) {
      return not_one_of("camera", asks.camera, cameras);
    }
    record_.title = "Risk: " + title_of(scenario->title, scenario->name);
    add_option("--camera", asks.camera);
    add_option("--rate", number_text(asks.rate_hz));
    if (!asks.map) {
      record_.options.emplace_back("--no-map");
      return {};
    }
    add_option("--map-km", number_text(asks.map_km));
    add_option("--cell-m", number_text(asks.cell_m));
    return {};
  }

  Status add(const HuntRequest& asks) {
    const Result<Scenario> scenario = read(asks.scenario);
    if (!scenario) return scenario.error();
    record_.title = "Worst flight: " + title_of(scenario->title, scenario->name);
    const Json document = hunt_document(asks);
    if (Status status = folder_.write_input(folder_.hunt_file(), document); !status) return status;
    // Limits change numbers only, but an entry of a list may lie where a command was allowed.
    const auto reach = runs_.library().reach_check();
    const auto check_flight = [&](const Scenario& flight) -> Status {
      if (is_cancelled(cancel_)) return Error{ErrorCode::kCancelled, "the client has gone"};
      if (Status allowed = reach(flight); !allowed) return allowed;
      return check_memory(flight);
    };
    const Result<Hunt> hunt = resolve_hunt(document,
                                           folder_.hunt_file().parent_path(),
                                           asks.estimator,
                                           {runs_.data_folders().sources, check_flight});
    if (!hunt) return without_input(hunt.error());
    record_.estimator = hunt->estimator;
    add_option("--estimator", hunt->estimator);
    return {};
  }

  /// The input is a file of this machine, which a client needs not know.
  [[nodiscard]] Error without_input(Error error) const {
    const std::string file = folder_.scenario_file().string() + ": ";
    for (std::size_t at = 0; (at = error.message.find(file, at)) != std::string::npos;) {
      error.message.erase(at, file.size());
    }
    return error;
  }

  [[nodiscard]] Json hunt_document(const HuntRequest& asks) const {
    Json axes = Json::array();
    for (const HuntAxis& axis : asks.axes) {
      axes.push_back({{"path", axis.path}, {"from", axis.from}, {"to", axis.to}});
      if (!axis.label.empty()) axes.back()["label"] = axis.label;
      if (!axis.unit.empty()) axes.back()["unit"] = axis.unit;
      if (axis.step) axes.back()["step"] = *axis.step;
    }
    Json document = {{"format_version", 1},
                     {"title", record_.title},
                     {"scenario", "scenario.json"},
                     {"axes", axes},
                     {"most_flights", asks.flights},
                     {"repeats", asks.repeats},
                     {"seed", asks.seed},
                     {"until", asks.all ? "flights" : "failure"}};
    if (asks.position_rmse_limit_m) document["position_rmse_limit_m"] = *asks.position_rmse_limit_m;
    return document;
  }

  RunManager& runs_;
  const StudyFolder& folder_;
  StudyRefusal& refusal_;
  const std::atomic<bool>* cancel_;
  StudyRecord record_;
};

bool is_above(const fs::path& folder, const fs::path& file) {
  const fs::path outer = fs::absolute(folder).lexically_normal();
  const auto [end, ignored] = std::mismatch(outer.begin(), outer.end(), file.begin(), file.end());
  return end == outer.end() || (std::next(end) == outer.end() && end->empty());
}

}  // namespace

Result<StudyRecord> prepare_study(RunManager& runs,
                                  const StudyRequest& request,
                                  const StudyFolder& folder,
                                  StudyRefusal& refusal,
                                  const std::atomic<bool>* cancel) {
  return Preparation(runs, folder, refusal, cancel).prepare(request);
}

Status check_again(RunManager& runs,
                   const StudyRecord& record,
                   const StudyFolder& folder,
                   StudyRefusal& refusal) {
  const Result<Scenario> scenario =
      record.kind == StudyKind::kExplain
          ? runs.scenario_of(record.subject)
          : load_scenario(folder.scenario_file(), {}, runs.data_folders().sources);
  if (!scenario) return scenario.error();
  return Preparation(runs, folder, refusal, nullptr).check(*scenario);
}

Result<std::vector<std::string>> study_arguments(const RunManager& runs,
                                                 const StudyRecord& record,
                                                 const StudyFolder& folder) {
  std::vector<std::string> words{to_string(record.kind)};
  fs::path input = record.kind == StudyKind::kHunt ? folder.hunt_file() : folder.scenario_file();
  DataFolders data = runs.data_folders();
  if (record.kind == StudyKind::kExplain) {
    const Result<fs::path> run = runs.folder(record.subject);
    if (!run) return run.error();
    input = fs::absolute(*run).lexically_normal();
    // A log or a live vehicle is flown again along the truth that this run recorded.
    data.folders.push_back(input);
    std::erase_if(data.closed, [&](const fs::path& closed) { return is_above(closed, input); });
  }
  words.push_back(fs::absolute(input).string());
  words.insert(words.end(), record.options.begin(), record.options.end());
  words.insert(words.end(),
               {"--out",
                folder.path().string(),
                "--jobs",
                std::to_string(record.jobs),
                "--progress",
                folder.progress_file().string(),
                "--quiet"});
  // The folder of a hunt stays; rendered pictures in it would take gigabytes.
  if (record.kind == StudyKind::kHunt) words.insert(words.end(), {"--frame-cache-gib", "0"});
  if (!data.sources.confined()) return words;
  const auto add = [&](const char* option, const std::vector<fs::path>& folders) {
    for (const fs::path& each : folders) {
      if (!each.empty()) words.insert(words.end(), {option, fs::absolute(each).string()});
    }
  };
  add("--files-in", data.folders);
  add("--files-not-in", data.closed);
  return words;
}

}  // namespace overfly::server::experiments
