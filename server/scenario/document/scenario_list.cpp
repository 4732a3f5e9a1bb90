#include "server/scenario/document/scenario_list.hpp"

#include <algorithm>

#include "flight/logs/flight_log.hpp"
#include "server/files/plain_name.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/scenario/document/scenario_file.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSchemaSuffix = ".schema.json";

ScenarioEntry entry_of(const fs::path& file, const SourcePolicy& sources) {
  ScenarioEntry entry;
  entry.name = file.stem().string();
  entry.file = file;
  entry.title = entry.name;
  Result<Scenario> scenario = load_scenario(file, {}, sources);
  if (!scenario) {
    entry.error = scenario.error().message;
    return entry;
  }
  scenario->sources = sources;
  entry.title = scenario->title;
  entry.description = scenario->description;
  const nlohmann::json& flight = scenario->resolved.at("flight");
  if (!flight.empty()) entry.flight = flight.begin().key();
  if (Status status = check_scenario(*scenario); !status) entry.error = status.error().message;
  return entry;
}

/// Checks the world's files, and whether its CRS texts are permitted.
Status check_world(const Scenario& scenario) {
  if (const auto* manifest = std::get_if<fs::path>(&scenario.world)) {
    return scenario.sources.check(*manifest, "world.manifest");
  }
  if (const auto* layers = std::get_if<terrain::WorldSpec>(&scenario.world)) {
    terrain::WorldSpec spec = *layers;
    spec.sources = scenario.sources;
    return terrain::check_world_sources(spec, "world.");
  }
  return {};
}

/// Checks a pose file or flight log, and the files that a log names.
Status check_log(const Scenario& scenario, const LoggedFlight& log) {
  const SourcePolicy& sources = scenario.sources;
  if (Status status = sources.check(log.file, "flight.log.file"); !status) return status;
  if (!flight::is_flight_log(log.file)) {
    // Poses in KITTI format take their times from that file.
    const fs::path times = log.file.parent_path() / "times.txt";
    return sources.check_place(times, "flight.log.file (a file next to it)");
  }
  if (Status status = check_start_of_log(scenario); !status) return status;
  const Result<std::vector<fs::path>> files = flight::logs::files_of_log(log.file);
  if (!files) return files.error();
  for (const fs::path& file : *files) {
    if (Status status = sources.check(file, "flight.log.file (a file that it names)"); !status) {
      return status;
    }
  }
  return {};
}

/// Scenario files of a folder, by name.
std::vector<fs::path> scenario_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const fs::path& file = entry->path();
    const std::string name = file.filename().string();
    if (file.extension() != ".json" || name.ends_with(kSchemaSuffix)) continue;
    if (is_plain_name(name)) files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::vector<ScenarioEntry> list_scenarios(const fs::path& folder, const SourcePolicy& sources) {
  std::vector<ScenarioEntry> entries;
  for (const fs::path& file : scenario_files(folder)) entries.push_back(entry_of(file, sources));
  return entries;
}

std::vector<fs::path> declared_folders(const fs::path& folder) {
  std::vector<fs::path> folders{folder};
  for (const fs::path& file : scenario_files(folder)) {
    const Result<Scenario> scenario = load_scenario(file);
    if (scenario && scenario->resolved.contains("data")) {
      folders.emplace_back(scenario->resolved.value("data", ""));
    }
  }
  return folders;
}

Result<fs::path> scenario_path(const fs::path& folder, const std::string& name) {
  fs::path file = folder / (name + ".json");
  std::error_code ignored;
  if (!is_plain_name(name) || name.ends_with(".schema") || !fs::is_regular_file(file, ignored)) {
    return Error{ErrorCode::kNotFound, "scenario \"" + name + "\": no such scenario"};
  }
  return file;
}

namespace {

/// The files that a live flight names.
Status check_live_files(const Scenario& scenario) {
  const auto* live = std::get_if<flight::live::LiveFlight>(&scenario.flight);
  if (live == nullptr) return {};
  if (live->mission_file) {
    Status status = scenario.sources.check(*live->mission_file, "flight.mavlink.mission_file");
    if (!status) return status;
  }
  if (!live->signing_key_file) return {};
  return scenario.sources.check(*live->signing_key_file, "flight.mavlink.signing_key_file");
}

/// The files of a mission, and of an airframe that flies it or the course.
Status check_mission_files(const Scenario& scenario) {
  if (const auto& flown = scenario.course_dynamics; flown && flown->airframe.name.empty()) {
    return scenario.sources.check(flown->airframe.file, "flight.course.dynamics");
  }
  const auto* mission = std::get_if<ScenarioMission>(&scenario.flight);
  if (mission == nullptr) return {};
  if (mission->plan.empty()) {
    Status status = scenario.sources.check(mission->file, "flight.mission.file");
    if (!status) return status;
  }
  if (!mission->airframe.name.empty()) return {};
  return scenario.sources.check(mission->airframe.file, "flight.mission.airframe");
}

}  // namespace

namespace {

/// The source of a camera's recorded images. The files in a folder are checked when it is opened.
Status check_recorded_images(const Scenario& scenario) {
  const CameraSpec* const camera = scenario.recorded_camera();
  if (camera == nullptr) return {};
  const RecordedImages& images = *camera->images;
  if (images.times) {
    if (Status status = scenario.sources.check(*images.times, "images.times"); !status) {
      return status;
    }
  }
  if (Status place = scenario.sources.check_place(images.source, "images.source"); !place) {
    return place;
  }
  std::error_code ignored;
  if (fs::is_directory(images.source, ignored)) return {};
  return scenario.sources.check(images.source, "images.source");
}

}  // namespace

Status check_start_of_log(const Scenario& scenario) {
  const auto* log = std::get_if<LoggedFlight>(&scenario.flight);
  if (log == nullptr || scenario.start_ns == 0 || !flight::is_flight_log(log->file)) return {};
  return Error{ErrorCode::kInvalidArgument,
               "start_s: must be 0 because " + log->file.string() +
                   " is a flight log: use flight.log.from_s"};
}

Status check_scenario(const Scenario& scenario) {
  std::optional<Error> error;
  if (Status status = check_recorded_images(scenario); !status) return status.error();
  if (const auto* run = std::get_if<RunFlight>(&scenario.flight)) {
    Status status = scenario.sources.check(truth_samples_file(run->folder), "flight.run.folder");
    if (status) status = scenario.sources.check(manifest_file(run->folder), "flight.run.folder");
    if (!status) return status.error();
  }
  if (Status status = check_live_files(scenario); !status) return status.error();
  if (Status status = check_world(scenario); !status) error = status.error();
  if (Status status = check_mission_files(scenario); !status && !error) error = status.error();
  if (const auto* log = std::get_if<Scenario::LoggedFlight>(&scenario.flight)) {
    const Status status = check_log(scenario, *log);
    if (!status && error) {
      error->message += "\n" + status.error().message;
      if (status.error().code != ErrorCode::kNotFound) error->code = status.error().code;
    } else if (!status) {
      error = status.error();
    }
  }
  if (!error) return {};
  if (error->code == ErrorCode::kNotFound && scenario.resolved.contains("data")) {
    error->message += "\n(data folder: " + scenario.resolved.value("data", "") +
                      "; set the environment variable OVERFLY_DATA to use another one)";
  }
  return *error;
}

}  // namespace overfly::server
