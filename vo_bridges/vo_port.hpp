// The interface between the flight range and a visual odometry estimator. An estimator receives
// images, intrinsics, exposure and time; it cannot access the truth.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/motion/estimate.hpp"
#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"

namespace overfly {

/// Samples of sensors that wait for a frame are kept for this time.
inline constexpr std::int64_t kOldestSampleNs = 10'000'000'000;

/// One image for an estimator. The image is shared and never modified after its creation.
struct VoFrame {
  std::string camera_id = "camera0";
  std::int64_t index = 0;              ///< frame number; gaps are dropped frames
  std::int64_t t_ns = 0;               ///< mid exposure of the middle row
  std::int64_t exposure_ns = 0;        ///< 0 = unknown
  std::shared_ptr<const Image> image;  ///< 8-bit grey
  PinholeCamera intrinsics;
  Distortion distortion;  ///< lens distortion of the image; none = pinhole
  /// Of the aircraft's other sensors since the previous frame; empty without them. The time of
  /// delivery is not after t_ns, unless a fault has changed this frame's stamp.
  SensorSamples sensors;
  /// crc32_of(*image), if known. An estimator outside this process must have received the same
  /// value.
  std::optional<std::uint32_t> image_crc32;
};

/// The estimator's answer to one frame.
struct VoEstimate {
  EstimateSample sample;  ///< frame and t_ns are those of the answered frame
  /// Why the received pose is invalid; empty if it is valid or absent.
  std::string pose_fault;
  /// Values of the pose's covariance as received, row by row: 9 or 36, see pose_covariance_from().
  /// PoseIntake moves them to `sample`. Empty if the estimator states none.
  std::vector<double> covariance;
  std::optional<Image> debug_image;            ///< RGB, same size as the frame or smaller
  std::vector<Eigen::Vector3f> map_points_vo;  ///< observed map points, in vo units; may be empty
  std::map<std::string, double> timing_ms;     ///< wall time by stage
  std::map<std::string, double> counters;      ///< e.g. features, inliers, keyframes
  /// Of the image as received by the estimator, if it reports this.
  std::optional<std::uint32_t> image_crc32;
};

/// Resources used by an estimator since its start.
struct ResourceUse {
  double cpu_s = 0.0;  ///< of all its threads
  double peak_memory_mb = 0.0;
  /// True: measured for the estimator's own process. False: as reported by an estimator within this
  /// process.
  bool own_process = true;
};

class VoPort {
 public:
  virtual ~VoPort() = default;

  /// The estimator's type ("feature", "perfect", ...).
  [[nodiscard]] virtual std::string type() const = 0;
  /// The parameters in effect, by the names used by the estimator, as written to the run's
  /// manifest.
  [[nodiscard]] virtual std::map<std::string, std::string> effective_parameters() const = 0;
  /// Sends the camera to the estimator and waits until it is ready for images, so that no frame is
  /// lost during its start. Optional, at most once, before the first frame; `track` does it
  /// otherwise.
  /// @param first  like the first frame, without its image
  /// Errors: as `track`; kCancelled.
  [[nodiscard]] virtual Status prepare(const VoFrame& /*first*/) { return {}; }
  /// Processes the next frame and returns its estimate. Frames have increasing index and time, and
  /// the size, intrinsics and distortion of the first frame.
  /// Lost tracking is a state, not an error.
  /// Errors: kInvalidArgument for an empty or colour image, an invalid or changed camera, and a
  /// frame that is not after the previous one; kInternal if the estimator has failed permanently
  /// (the run is CRASHED).
  [[nodiscard]] virtual Result<VoEstimate> track(const VoFrame& frame) = 0;
  /// Whether `track` produces debug images and map points, which cost time. Default: no.
  virtual void set_debug(bool wanted) = 0;
  /// Log lines of the estimator and output lines of its process since the last call, without line
  /// ends. May be called from another thread than `track`.
  [[nodiscard]] virtual std::vector<std::string> take_log() { return {}; }
  /// Empty if unknown. May be called from another thread than `track`.
  [[nodiscard]] virtual std::optional<ResourceUse> resource_use() const { return std::nullopt; }
};

/// Checks the general requirements of a frame; `previous` is the previous frame, or null.
[[nodiscard]] Status validate_vo_frame(const VoFrame& frame, const VoFrame* previous);

}  // namespace overfly
