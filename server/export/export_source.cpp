#include "server/export/export_source.hpp"

#include <utility>

#include "server/camera/truth.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_records.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Default if neither run nor scenario gives a date: 2026-01-01T00:00:00Z, as in a lockstep run's
/// manifest.
constexpr std::int64_t kEpochUtcNs = 1'767'225'600 * kNsPerS;

/// File and digest of each data file of the world; none if the run ended before it was opened.
std::vector<std::pair<std::string, std::string>> digests_of(const RunManifest& manifest) {
  std::vector<std::pair<std::string, std::string>> digests;
  if (!manifest.world) return digests;
  for (const RunManifest::WorldFile& file : manifest.world->data_hashes) {
    digests.emplace_back(file.file, file.digest);
  }
  return digests;
}

/// The answers of all estimators, aligned where the run has been scored.
std::vector<PlannedEstimate> estimates_of(const fs::path& folder, const RunRecords& records) {
  const Result<RunMetrics> metrics = read_run_metrics(folder);
  std::vector<PlannedEstimate> estimates;
  for (const EstimatorRecords& estimator : records.estimators) {
    PlannedEstimate& estimate = estimates.emplace_back();
    estimate.track = track_of(estimator);
    if (!metrics) continue;
    const auto scored = metrics->estimators.find(estimator.name);
    if (scored == metrics->estimators.end() || !scored->second.map_id) continue;
    const auto& alignments = scored->second.score.alignments;
    const auto aligned = alignments.find(evaluation::AlignmentMode::kSim3);
    if (aligned == alignments.end()) continue;
    estimate.S_world_vo = aligned->second.S_world_vo;
    estimate.map_id = *scored->second.map_id;
  }
  return estimates;
}

Result<ExportSource> open_run(const fs::path& folder) {
  const Result<ReadManifest> manifest = read_run_manifest(folder);
  if (!manifest) return manifest.error();
  if (Status status = manifest->check(ManifestPart::kWorld); !status) return status.error();
  Result<Json> document = read_json(scenario_file(folder));
  if (!document) return document.error();
  Result<Scenario> scenario = resolve_scenario(std::move(*document), {}, folder);
  if (!scenario) return scenario.error().in(scenario_file(folder).string());
  Result<RunRecords> records = read_run_records(folder, *manifest);
  if (!records) return records.error();
  std::vector<PlannedEstimate> estimates = estimates_of(folder, *records);
  std::map<std::string, CameraModel> calibrated;
  for (const RunManifest::Camera& camera : manifest->values.cameras) {
    if (camera.calibrated) calibrated[camera.name] = camera.calibrated->model;
  }
  ExportSource source{std::move(*scenario),
                      RecordedRun{folder,
                                  std::move(records->cameras[kMainCamera].frames),
                                  digests_of(manifest->values),
                                  manifest->values.flight.value_or(RunManifest::Flight{}),
                                  std::move(estimates),
                                  std::move(calibrated)},
                      manifest->values.epoch_utc_ns.value_or(kEpochUtcNs)};
  if (source.run->frames.empty()) {
    return Error{ErrorCode::kNotFound, folder.string() + ": the run recorded no frames"};
  }
  return source;
}

}  // namespace

Result<ExportSource> open_export_source(const fs::path& path,
                                        const std::vector<Override>& overrides) {
  std::error_code failed;
  if (fs::is_directory(path, failed)) {
    if (!overrides.empty()) {
      return Error{
          ErrorCode::kInvalidArgument,
          path.string() + ": a run is exported as it was flown; --set applies only to scenarios"};
    }
    return open_run(path);
  }
  Result<Scenario> scenario = load_scenario(path, overrides);
  if (!scenario) return scenario.error();
  const std::int64_t epoch_ns = scenario->epoch_utc_ns.value_or(kEpochUtcNs);
  return ExportSource{std::move(*scenario), std::nullopt, epoch_ns};
}

Result<std::unique_ptr<TruthSource>> open_truth(const ExportSource& source,
                                                const terrain::World& world) {
  if (!source.run) return create_truth(source.scenario, world);
  return open_flown_truth(source.run->folder, source.run->flight, source.scenario, world);
}

Status check_world(const ExportSource& source, const terrain::World& world) {
  if (!source.run) return {};
  const auto conflict = [&](const std::string& what) {
    return Error{ErrorCode::kConflict,
                 source.run->folder.string() + ": " + what +
                     "; its frames cannot be rendered again over another world"};
  };
  const auto& then = source.run->world_digests;
  const auto& now = world.data_hashes;
  if (then.size() != now.size()) {
    return conflict("the world had " + std::to_string(then.size()) + " data files, it has " +
                    std::to_string(now.size()));
  }
  for (std::size_t i = 0; i < then.size(); ++i) {
    if (then[i].second == now[i].second) continue;
    return conflict("world file " + now[i].first + " has the digest " + now[i].second +
                    ", the run flew over " + then[i].second);
  }
  return {};
}

}  // namespace overfly::server
