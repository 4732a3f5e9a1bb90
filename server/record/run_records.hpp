// All records of a run; trajectories and metrics are derived from them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/motion/trajectory.hpp"
#include "core/result.hpp"
#include "evaluation/evaluation.hpp"
#include "server/record/rows/run_rows.hpp"
#include "server/record/run_info.hpp"
#include "server/record/run_manifest.hpp"

namespace overfly::server {

struct EstimatorRecords {
  std::string name;
  std::string type;
  std::vector<EstimateRecord> records;  ///< by frame, including drops
  std::size_t camera = kMainCamera;     ///< index in RunRecords::cameras
};

struct CameraRecords {
  std::string name;
  Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  std::vector<FrameRow> frames;
};

struct RunRecords {
  std::vector<CameraRecords> cameras{1};  ///< never empty
  /// Frames that no camera drew because their time had passed.
  std::vector<evaluation::FlightFrame> late_frames;
  std::vector<EstimatorRecords> estimators;

  [[nodiscard]] const CameraRecords& main_camera() const { return cameras.at(kMainCamera); }
  /// The camera whose images an estimator gets.
  [[nodiscard]] const CameraRecords& camera_of(const EstimatorRecords& estimator) const {
    return cameras.at(estimator.camera);
  }
};

/// Reads the line files of a run folder; they stay readable after a kill.
/// Errors: kNotFound without a manifest; kUnreadable naming file and row, or the manifest's field.
[[nodiscard]] Result<RunRecords> read_run_records(const std::filesystem::path& folder);
/// @param manifest  of that folder
[[nodiscard]] Result<RunRecords> read_run_records(const std::filesystem::path& folder,
                                                  const ReadManifest& manifest);

/// T_world_camera of every frame of a camera.
[[nodiscard]] Result<Trajectory> truth_of(const CameraRecords& camera);
/// A camera's record of one frame; null when there is none.
[[nodiscard]] const FrameRow* frame_row(const CameraRecords& camera, std::int64_t frame);
/// Every frame of a camera in the flight, including those that were late or lost.
[[nodiscard]] std::vector<evaluation::FlightFrame> flight_frames(const RunRecords& records,
                                                                 const CameraRecords& camera);
/// The answers of one estimator without the drops.
[[nodiscard]] EstimateTrack track_of(const EstimatorRecords& estimator);

/// The basis of `init_scale`: the first tracked frame of the map that is scored. That map is the
/// one with the most tracked frames (the earlier one on a tie).
struct InitialFrame {
  std::int64_t frame = 0;
  int map_id = 0;
  std::optional<double> true_depth_m;
  std::optional<double> scene_depth;
};
[[nodiscard]] std::optional<InitialFrame> initial_frame(const RunRecords& records,
                                                        const EstimatorRecords& estimator);

}  // namespace overfly::server
