// Writers of common data set formats, one for each format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/motion/estimate.hpp"
#include "core/result.hpp"
#include "flight/sensors/imu.hpp"
#include "server/camera/frame_maker.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

enum class DatasetFormat { kTumMono, kEuroc, kKitti, kPng, kLcm, kRosbag, kMcap };

/// "tum-mono", "euroc", "kitti", "png", "lcm", "rosbag", "mcap".
[[nodiscard]] const char* to_string(DatasetFormat format);
[[nodiscard]] std::optional<DatasetFormat> dataset_format_from(const std::string& text);

/// The answers of one estimator of a run.
struct PlannedEstimate {
  EstimateTrack track;  ///< by frame
  /// Of the map that was scored, by the alignment `sim3`; empty if it is unavailable.
  std::optional<Similarity> S_world_vo;
  int map_id = 0;  ///< that map
};

/// What a writer needs to know before the first frame.
struct DatasetPlan {
  std::filesystem::path folder;  ///< exists and is empty
  /// Cameras to write, in this order. Their models are those that estimators are given: of a camera
  /// with `calibrated` the calibration.
  std::vector<CameraSpec> cameras;
  std::vector<CameraModel> true_models;  ///< of these cameras
  FrameRate rate;
  std::int64_t last_frame = 0;    ///< the highest index that may occur
  std::int64_t epoch_utc_ns = 0;  ///< Unix time of t = 0
  flight::ImuModel imu_model;
  /// The samples are those of the aircraft's own IMU: its rate is measured, its biases and noise
  /// are not known.
  bool imu_of_vehicle = false;
  std::vector<flight::ImuReading> imu;     ///< over the exported time span; EuRoC only
  double gravity_m_s2 = 0.0;               ///< magnitude, in the IMU's samples
  std::vector<AircraftState> states;       ///< one for each IMU sample
  std::vector<PlannedEstimate> estimates;  ///< of a run; LCM, rosbag, MCAP only
};

/// Takes the frames in order; writes their images at once and the text files at the end. Images
/// that were not delivered (CameraShot::delivered) are not part of a data set.
class DatasetWriter {
 public:
  virtual ~DatasetWriter() = default;

  /// @param frame  its shots are of the plan's cameras, in their order
  /// @return for each shot the name of its image without folder and extension; empty for a lost one
  /// Errors: kIo naming the file.
  [[nodiscard]] virtual Result<std::vector<std::string>> add(const MadeFrame& frame) = 0;
  /// Writes the files that describe the added images; nothing may be added afterwards.
  [[nodiscard]] virtual Status finish() = 0;
};

/// Errors: kUnsupported if the format cannot represent the plan, naming camera and reason.
[[nodiscard]] Result<std::unique_ptr<DatasetWriter>> create_dataset_writer(DatasetFormat format,
                                                                           const DatasetPlan& plan);

/// The writers of each format (create_dataset_writer chooses).
[[nodiscard]] Result<std::unique_ptr<DatasetWriter>> create_tum_mono_writer(const DatasetPlan&);
[[nodiscard]] Result<std::unique_ptr<DatasetWriter>> create_euroc_writer(const DatasetPlan&);
[[nodiscard]] Result<std::unique_ptr<DatasetWriter>> create_kitti_writer(const DatasetPlan&);
[[nodiscard]] Result<std::unique_ptr<DatasetWriter>> create_png_writer(const DatasetPlan&);
[[nodiscard]] Result<std::unique_ptr<DatasetWriter>> create_lcm_writer(const DatasetPlan&);
[[nodiscard]] Result<std::unique_ptr<DatasetWriter>> create_rosbag_writer(const DatasetPlan&);
[[nodiscard]] Result<std::unique_ptr<DatasetWriter>> create_mcap_writer(const DatasetPlan&);

/// Creates a folder with its parents. Errors: kIo naming it.
[[nodiscard]] Status make_folder(const std::filesystem::path& folder);

}  // namespace overfly::server
