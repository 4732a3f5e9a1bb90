#include "server/trajectories/run_trajectory.hpp"

#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "core/outside/source_policy.hpp"
#include "core/text/shown_path.hpp"
#include "evaluation/evaluation.hpp"
#include "server/files/plain_name.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_manifest.hpp"
#include "server/scoring/metrics.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTruthPart = "truth";
constexpr const char* kCamerasPart = "cameras/";

/// The trajectory's file in the run's folder, and the camera whose poses it has.
struct RunFile {
  fs::path file;
  std::string camera;  ///< empty: the main camera
  std::string estimator;
};

std::optional<RunFile> run_file(const fs::path& folder, const std::string& part) {
  if (part == kTruthPart) return RunFile{CameraFiles::of_main_camera(folder).truth(), "", ""};
  if (part.starts_with(kCamerasPart)) {
    const std::string camera = part.substr(std::string(kCamerasPart).size());
    if (!is_plain_name(camera)) return std::nullopt;
    return RunFile{CameraFiles(folder, 1, camera).truth(), camera, ""};
  }
  if (!is_plain_name(part)) return std::nullopt;
  return RunFile{estimate_tum_file(folder, part), "", part};
}

/// Errors: kNotFound, also where a link leads out of the folder; as read_trajectory and
/// missing_trajectory.
Result<TrajectoryFile> read_or_make(const fs::path& folder,
                                    const fs::path& file,
                                    const std::atomic<bool>* cancel) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(file, ignored))) {
    Result<RunTrajectory> made = missing_trajectory(folder, file);
    if (!made) return made.error();
    TrajectoryFile poses;
    poses.trajectory = std::move(made->poses);
    poses.comments = std::move(made->comments);
    return poses;
  }
  if (!SourcePolicy::inside({folder}).check(file, "run")) {
    return Error{ErrorCode::kNotFound, file.string() + ": leads out of the run's folder"};
  }
  return read_trajectory(file, kServedTrajectoryLimits, cancel);
}

/// The mount of the camera whose poses a file has; of the nadir camera if the manifest has none.
Pose run_mount_of(const fs::path& folder, RunFile file) {
  const Result<ReadManifest> manifest = read_run_manifest(folder);
  if (!manifest) return RunManifest::Camera().T_body_camera;
  for (const RunManifest::Estimator& estimator : manifest->values.estimators) {
    if (estimator.name == file.estimator) file.camera = estimator.camera;
  }
  const std::vector<RunManifest::Camera>& cameras = manifest->values.cameras;
  for (const RunManifest::Camera& camera : cameras) {
    if (camera.name == file.camera) return camera.T_body_camera;
  }
  return cameras.empty() ? RunManifest::Camera().T_body_camera : cameras.front().T_body_camera;
}

std::optional<RunOutcome> outcome_of(const fs::path& folder, const std::string& estimator) {
  if (estimator.empty()) return std::nullopt;
  const Result<RunMetrics> metrics = read_run_metrics(folder);
  if (!metrics) return std::nullopt;
  const auto found = metrics->estimators.find(estimator);
  if (found == metrics->estimators.end()) return std::nullopt;
  const evaluation::Score& score = found->second.score;
  return RunOutcome{evaluation::to_string(score.outcome), score.outcome_time_s, score.coverage};
}

}  // namespace

Result<ServedTrajectory> read_run_trajectory(const fs::path& folder,
                                             const std::string& part,
                                             const std::string& reference,
                                             const std::atomic<bool>* cancel) {
  const std::optional<RunFile> file = run_file(folder, part);
  if (!file) return no_such_trajectory(reference);
  Result<TrajectoryFile> poses = read_or_make(folder, file->file, cancel);
  if (!poses && poses.error().code == ErrorCode::kNotFound) return no_such_trajectory(reference);
  if (!poses) {
    return Error{poses.error().code, shown_without(folder, reference, poses.error().message)};
  }
  ServedTrajectory trajectory;
  trajectory.file = std::move(*poses);
  trajectory.kind = "run";
  trajectory.T_body_pose = run_mount_of(folder, *file);
  trajectory.outcome = outcome_of(folder, file->estimator);
  return trajectory;
}

}  // namespace overfly::server
