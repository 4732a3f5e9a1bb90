// Samples of the aircraft's sensors in an export: as recorded, or measured again.
#pragma once

#include <functional>
#include <optional>

#include "core/result.hpp"
#include "flight/sensors/sensor_models.hpp"
#include "server/export/dataset_writer.hpp"
#include "server/export/export_source.hpp"
#include "server/export/frame_sequence.hpp"
#include "server/record/rows/sensor_files.hpp"

namespace overfly::server {

/// Adds to a plan the IMU samples from one frame before the first to one frame after the last, and
/// the states at their times: the samples that a run recorded if its aircraft has an IMU, otherwise
/// synthesised ones. The biases of a live vehicle's own IMU are not known, and are zero.
/// @param wanted  as ExportOptions::imu; of a vehicle's own IMU it gives the noise only
/// Errors: kInvalidArgument for a wanted IMU if the scenario has one; as synthesize_imu and
/// SensorFilesReader.
[[nodiscard]] Status add_inertial_data(const ExportSource& source,
                                       const std::optional<flight::ImuModel>& wanted,
                                       FrameSequence& frames,
                                       const std::function<bool()>& keep_going,
                                       DatasetPlan& plan);

/// Gives each exported frame the samples since the previous one.
class FrameSamples {
 public:
  /// Errors: as SensorFilesReader::open.
  static Result<FrameSamples> open(const ExportSource& source);
  /// The first frame gets those that became available during one frame period. Frames must come in
  /// order. Errors: as SensorFilesReader::until.
  [[nodiscard]] Status add_to(MadeFrame& frame);

 private:
  explicit FrameSamples(std::int64_t period_ns) : period_ns_(period_ns) {}

  std::int64_t period_ns_;
  std::optional<SensorFilesReader> recorded_;  ///< empty: the frame maker has measured
  std::optional<std::int64_t> previous_ns_;    ///< time of the previous frame
};

}  // namespace overfly::server
