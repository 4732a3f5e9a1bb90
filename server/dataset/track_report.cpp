#include "server/dataset/track_report.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "core/time.hpp"
#include "evaluation/long_steps.hpp"
#include "server/record/rows/rows.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

std::optional<std::string> crash_of(const TrackedDataset& tracked) {
  if (tracked.records.empty() || tracked.records.back().crash.empty()) return std::nullopt;
  return tracked.records.back().crash;
}

Json dataset_json(const Dataset& dataset) {
  return {{"folder", dataset.folder.string()},
          {"layout", to_string(dataset.layout)},
          {"camera_name", dataset.camera_name},
          {"images", dataset.images.size()},
          {"duration_s", s_from_ns(dataset.images.back().t_ns - dataset.images.front().t_ns)},
          {"camera", json_from(dataset.camera)},
          {"notes", dataset.notes}};
}

Json resources_json(const TrackedDataset& tracked, const TrackFigures& figures) {
  return {{"of", figures.measured_process},
          {"cpu_s", tracked.resources.cpu_s},
          {"cpu_percent", figures.cpu_percent},
          {"peak_memory_mb", tracked.resources.peak_memory_mb}};
}

/// All images, whether or not the estimator answered; for a cancelled pass only those before the
/// cancellation.
std::vector<evaluation::FlightFrame> flight_of(const Dataset& dataset,
                                               const TrackedDataset& tracked) {
  std::vector<evaluation::FlightFrame> flight;
  for (const DatasetImage& image : dataset.images) {
    if (tracked.cancelled && flight.size() == tracked.records.size()) break;
    flight.push_back({image.index, image.t_ns});
  }
  return flight;
}

/// Converts a trajectory to the poses of another frame that is rigidly attached.
Result<Trajectory> moved(const Trajectory& trajectory, const Pose& T_given_wanted) {
  std::vector<StampedPose> poses = trajectory.poses();
  for (StampedPose& stamped : poses) stamped.pose = stamped.pose * T_given_wanted;
  return Trajectory::from_poses(poses);
}

/// The poses of a truth as those of the camera.
Result<Trajectory> as_camera_poses(const Dataset& dataset,
                                   const TrajectoryFile& truth,
                                   std::vector<std::string>& notes) {
  if (truth.format == TrajectoryFormat::kEuroc && dataset.T_body_camera) {
    notes.emplace_back(
        "the truth gives poses of the body; those of the camera are computed with T_BS");
    return moved(truth.trajectory, *dataset.T_body_camera);
  }
  const bool of_another = dataset.T_first_camera && !dataset.T_first_camera->translation.isZero();
  if (truth.format == TrajectoryFormat::kKitti && of_another) {
    notes.push_back("the truth gives poses of image_0; those of " + dataset.camera_name +
                    " are computed with calib.txt");
    return moved(truth.trajectory, *dataset.T_first_camera);
  }
  return truth.trajectory;
}

}  // namespace

Result<Trajectory> camera_truth(const Dataset& dataset,
                                const TrajectoryFile& truth,
                                std::vector<std::string>& notes) {
  if (!dataset.T_body_camera) {
    notes.emplace_back(
        "the camera's mount is not known: the Euler angles assume a camera that looks straight "
        "down");
  }
  if (truth.unknown_poses > 0) {
    notes.push_back("unknown poses in the truth: " + std::to_string(truth.unknown_poses) +
                    "; frames in these gaps are not scored");
  }
  Result<Trajectory> camera = as_camera_poses(dataset, truth, notes);
  if (!camera) return camera;
  const evaluation::LongSteps steps = evaluation::long_steps(*camera);
  if (steps.ending.empty()) return camera;
  notes.push_back("of the truth, " + evaluation::words_for(steps) +
                  "; frames in them are not scored");
  return evaluation::with_gaps_in(steps, std::move(*camera));
}

namespace {

/// Poses without times, at those of the images with their numbers.
Trajectory at_times_of(const Dataset& dataset, const Trajectory& poses) {
  Trajectory stamped;
  const std::size_t count = std::min(poses.size(), dataset.images.size());
  for (std::size_t i = 0; i < count; ++i) {
    // Stamps of images increase.
    if (!stamped.append({dataset.images[i].t_ns, poses.poses()[i].pose})) break;
  }
  return stamped;
}

}  // namespace

evaluation::Score score_of(const Dataset& dataset,
                           const TrackedDataset& tracked,
                           const Trajectory& T_world_camera,
                           bool truth_has_times,
                           std::optional<double> init_true_depth_m) {
  evaluation::Options options;
  options.init_true_depth_m = init_true_depth_m;
  if (dataset.T_body_camera) options.T_body_camera = *dataset.T_body_camera;
  EstimateTrack track = track_of(tracked);
  options.flight = flight_of(dataset, tracked);
  if (!truth_has_times) {
    // Line i of a file without times belongs to image i.
    options.association = evaluation::Association::kIndex;
    for (std::size_t i = 0; i < track.samples.size(); ++i) {
      track.samples[i].frame = static_cast<std::int64_t>(i);
    }
    for (std::size_t i = 0; i < options.flight.size(); ++i) {
      options.flight[i].frame = static_cast<std::int64_t>(i);
    }
  }
  const Trajectory truth = truth_has_times ? T_world_camera : at_times_of(dataset, T_world_camera);
  evaluation::Score score = evaluation::score(truth, track, options);
  if (crash_of(tracked)) {
    score.outcome =
        tracked.records.back().hung ? evaluation::Outcome::kTimeout : evaluation::Outcome::kCrashed;
    evaluation::set_outcome_time(truth, s_from_ns(track.samples.back().t_ns), &score);
  }
  return score;
}

TrackFigures figures_of(const TrackedDataset& tracked) {
  TrackFigures figures;
  std::set<int> maps;
  for (const EstimateRecord& record : tracked.records) {
    switch (record.sample.state) {
      case TrackingState::kInitialising:
        ++figures.initialising_frames;
        break;
      case TrackingState::kLost:
        ++figures.lost_frames;
        break;
      case TrackingState::kTracking:
        ++figures.tracked_frames;
        maps.insert(record.sample.map_id);
        if (!figures.initialised_after_s) {
          figures.initialised_after_s =
              s_from_ns(record.sample.t_ns - tracked.records.front().sample.t_ns);
        }
        break;
    }
  }
  figures.maps = static_cast<int>(maps.size());
  figures.crash = crash_of(tracked);
  figures.hung = figures.crash && tracked.records.back().hung;
  const std::vector<double>& ms = tracked.tracking.ms;
  const double wall_s = 1e-3 * std::accumulate(ms.begin(), ms.end(), 0.0);
  if (wall_s > 0.0) figures.cpu_percent = 100.0 * tracked.resources.cpu_s / wall_s;
  figures.measured_process = tracked.own_process ? "the estimator's process" : "this process";
  return figures;
}

Json report_json(const Dataset& dataset,
                 const TrackedDataset& tracked,
                 const std::optional<evaluation::Score>& score) {
  Json stages = Json::object();
  for (const auto& [stage, durations] : tracked.stages) stages[stage] = durations.summary();
  const TrackFigures figures = figures_of(tracked);
  Json report = {{"dataset", dataset_json(dataset)},
                 {"warnings", dataset.warnings},
                 {"estimator", {{"type", tracked.type}, {"parameters", tracked.parameters}}},
                 {"frames", tracked.records.size()},
                 {"complete", tracked.records.size() == dataset.images.size() && !figures.crash},
                 {"states",
                  {{"INITIALISING", figures.initialising_frames},
                   {"TRACKING", figures.tracked_frames},
                   {"LOST", figures.lost_frames}}},
                 {"initialised_after_s",
                  figures.initialised_after_s ? Json(*figures.initialised_after_s) : Json(nullptr)},
                 {"maps", figures.maps},
                 {"unanswered", tracked.unanswered},
                 {"hash_mismatches", tracked.hash_mismatches},
                 {"crash", figures.crash ? Json(*figures.crash) : Json(nullptr)},
                 {"timing",
                  {{"read", tracked.reading.summary()},
                   {"track", tracked.tracking.summary()},
                   {"stages", std::move(stages)}}},
                 {"resources", resources_json(tracked, figures)}};
  if (score) report["score"] = json_from(*score);
  return report;
}

}  // namespace overfly::server
