// LCM event logs of a camera's images, calibration, times and true poses: what an estimator on LCM
// would have heard, and where the camera was.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/camera_model.hpp"
#include "core/image.hpp"
#include "core/pose.hpp"
#include "core/result.hpp"

namespace overfly {

/// One image for a log.
struct LcmLogImage {
  std::int64_t frame = 0;
  std::int64_t stamp_ns = 0;     ///< since the run's start
  std::int64_t exposure_ns = 0;  ///< 0 = not known
  const Image& image;            ///< grey
};

/// The true pose of a frame's camera.
struct LcmLogTruth {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  std::int64_t stamp_ns = 0;  ///< of the image
  Pose T_world_camera;
};

/// Events carry the time epoch + stamp. Every camera has its own channel prefix.
class LcmLogWriter {
 public:
  /// @param epoch_utc_ns  Unix time of t = 0
  /// Errors: kUnsupported where LCM is not built in; kIo naming the file.
  static Result<std::unique_ptr<LcmLogWriter>> create(const std::filesystem::path& file,
                                                      std::int64_t epoch_utc_ns);
  virtual ~LcmLogWriter() = default;

  /// PREFIX_CALIBRATION, with the time of the images after it. May be repeated for players that
  /// begin within the log: it is one session.
  [[nodiscard]] virtual Status write_calibration(const std::string& prefix,
                                                 const std::string& camera,
                                                 const CameraModel& model,
                                                 std::int64_t stamp_ns) = 0;
  /// PREFIX_IMAGE and PREFIX_TIME.
  [[nodiscard]] virtual Status write_image(const std::string& prefix, const LcmLogImage& image) = 0;
  /// PREFIX_TRUTH.
  [[nodiscard]] virtual Status write_truth(const std::string& prefix, const LcmLogTruth& truth) = 0;
  /// Whether all of it is on its way to the disk. Errors: kIo naming the file.
  [[nodiscard]] virtual Status finish() = 0;
};

}  // namespace overfly
