// All records of a run; trajectories and metrics are derived from them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/trajectory.hpp"
#include "evaluation/evaluation.hpp"
#include "server/record/run_rows.hpp"

namespace overfly::engine {

struct EstimatorRecords {
  std::string name;
  std::string type;
  std::vector<EstimateRecord> records;  ///< by frame, including drops
  std::size_t camera = 0;               ///< index: 0 = the main one
};

/// Records of a camera other than the main one.
struct CameraRecords {
  std::string name;
  Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  std::vector<FrameRecord> frames;
};

struct RunRecords {
  Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  std::vector<FrameRecord> frames;
  std::vector<CameraRecords> other_cameras;  ///< all except the main camera, which is above
  /// Frames that no camera drew because their time had passed.
  std::vector<evaluation::FlightFrame> late_frames;
  std::vector<EstimatorRecords> estimators;

  /// By index; 0 = the main camera.
  [[nodiscard]] const Pose& mount_of(std::size_t camera) const {
    return camera == 0 ? T_body_camera : other_cameras.at(camera - 1).T_body_camera;
  }
  [[nodiscard]] const std::vector<FrameRecord>& frames_of(std::size_t camera) const {
    return camera == 0 ? frames : other_cameras.at(camera - 1).frames;
  }
};

/// Reads the line files of a run folder; they stay readable after a kill.
/// Errors: kNotFound without a manifest; kUnreadable naming file and row.
[[nodiscard]] Result<RunRecords> read_run_records(const std::filesystem::path& folder);

/// T_world_camera of every frame of a camera.
[[nodiscard]] Result<Trajectory> truth_of(const RunRecords& records, std::size_t camera = 0);
/// A camera's record of one frame; null when there is none.
[[nodiscard]] const FrameRecord* frame_record(const RunRecords& records,
                                              std::size_t camera,
                                              std::int64_t frame);
/// Every frame of a camera in the flight, including those that were late or lost.
[[nodiscard]] std::vector<evaluation::FlightFrame> flight_frames(const RunRecords& records,
                                                                 std::size_t camera);
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

}  // namespace overfly::engine
