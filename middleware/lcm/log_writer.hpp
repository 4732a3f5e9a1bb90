// Writes LCM event logs with a camera's images, calibration, times and true poses, and with samples
// of the aircraft's other sensors: the messages that an estimator on LCM would have received, the
// truth, and the answers of a run's estimators.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/motion/estimate.hpp"
#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"

namespace overfly::lcm {

/// An image for a log.
struct LogImage {
  std::int64_t frame = 0;
  std::int64_t stamp_ns = 0;     ///< since the start of the run
  std::int64_t exposure_ns = 0;  ///< 0 = unknown
  const Image& image;            ///< grey
};

/// The true camera pose of a frame.
struct LogTruth {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  std::int64_t stamp_ns = 0;  ///< of the image
  Pose T_world_camera;
};

/// Events have the time epoch + stamp. Each camera has its own channel prefix.
class LogWriter {
 public:
  /// @param epoch_utc_ns  Unix time of t = 0
  /// Errors: kUnsupported if LCM is not built in; kIo naming the file.
  static Result<std::unique_ptr<LogWriter>> create(const std::filesystem::path& file,
                                                   std::int64_t epoch_utc_ns);
  virtual ~LogWriter() = default;

  /// Writes PREFIX_CALIBRATION with the time of the images that follow. May be repeated for players
  /// that start within the log; the session stays the same.
  [[nodiscard]] virtual Status write_calibration(const std::string& prefix,
                                                 const std::string& camera,
                                                 const CameraModel& model,
                                                 std::int64_t stamp_ns) = 0;
  /// Writes PREFIX_IMAGE and PREFIX_TIME.
  [[nodiscard]] virtual Status write_image(const std::string& prefix, const LogImage& image) = 0;
  /// Writes PREFIX_TRUTH.
  [[nodiscard]] virtual Status write_truth(const std::string& prefix, const LogTruth& truth) = 0;
  /// Writes the samples of the aircraft's sensors to PREFIX_IMU, PREFIX_GPS and so on. Each event
  /// has the time at which the sample was available.
  [[nodiscard]] virtual Status write_samples(const std::string& prefix,
                                             const SensorSamples& samples) = 0;
  /// Writes an answer of an estimator to ESTIMATE_NAME_POSE.
  [[nodiscard]] virtual Status write_estimate(const std::string& estimator,
                                              const EstimateSample& sample) = 0;
  /// Writes the pose in the world of a tracked frame to ESTIMATE_NAME_POSE_WORLD.
  [[nodiscard]] virtual Status write_world_estimate(const std::string& estimator,
                                                    const EstimateSample& sample,
                                                    const Pose& T_world_camera) = 0;
  /// Flushes the log. Errors: kIo naming the file.
  [[nodiscard]] virtual Status finish() = 0;
};

}  // namespace overfly::lcm
