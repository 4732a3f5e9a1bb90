// The one interface between the range and a visual-odometry estimator. An estimator receives
// images, intrinsics, exposure and time: it cannot reach the truth.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/camera_model.hpp"
#include "core/estimate.hpp"
#include "core/image.hpp"
#include "core/result.hpp"

namespace overfly {

/// One inertial sample, body axes (forward-right-down).
struct ImuSample {
  std::int64_t t_ns = 0;
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();  ///< specific force
  Eigen::Vector3d angular_rate_rad_s = Eigen::Vector3d::Zero();
};

/// One image for an estimator. The image is shared and never written to after it is made.
struct VoFrame {
  std::string camera_id = "camera0";
  std::int64_t index = 0;              ///< frame number; gaps are dropped frames
  std::int64_t t_ns = 0;               ///< mid exposure of the middle row
  std::int64_t exposure_ns = 0;        ///< 0 = not known
  std::shared_ptr<const Image> image;  ///< 8-bit grey
  PinholeCamera intrinsics;
  Distortion distortion;       ///< of the lens the image was taken through; none = a pinhole
  std::vector<ImuSample> imu;  ///< since the frame before; empty without an IMU
  /// crc32_of(*image), where known: what an estimator beyond this process received must equal it.
  std::optional<std::uint32_t> image_crc32;
};

/// The estimator's answer to one frame.
struct VoEstimate {
  EstimateSample sample;  ///< frame and t_ns are those of the frame it answers
  /// Why the pose that came with it is none; empty where it is one (or none came).
  std::string pose_fault;
  std::optional<Image> debug_image;            ///< RGB, same size as the frame or smaller
  std::vector<Eigen::Vector3f> map_points_vo;  ///< sparse map seen now, in vo units; may be empty
  std::map<std::string, double> timing_ms;     ///< wall time by stage
  std::map<std::string, double> counters;      ///< e.g. features, inliers, keyframes
  /// Of the image as it arrived where the estimator runs, as far as that place tells.
  std::optional<std::uint32_t> image_crc32;
};

/// What an estimator has used since it began.
struct ResourceUse {
  double cpu_s = 0.0;  ///< of all its threads
  double peak_memory_mb = 0.0;
  /// True: its own process has used it. False: by its own account, where it runs in ours.
  bool own_process = true;
};

class VoPort {
 public:
  virtual ~VoPort() = default;

  /// The estimator's type ("feature", "perfect", ...).
  [[nodiscard]] virtual std::string type() const = 0;
  /// The parameters in force, by their names in the field, as printed into the run's manifest.
  [[nodiscard]] virtual std::map<std::string, std::string> effective_parameters() const = 0;
  /// Tells the estimator its camera and waits until it is ready for images, so that no frame is
  /// lost to its start. May be left out: `track` does what is missing. Once, before the first
  /// frame.
  /// @param first  as the first frame will be, without its image
  /// Errors: as `track`; kCancelled.
  [[nodiscard]] virtual Status prepare(const VoFrame& /*first*/) { return {}; }
  /// Takes the next frame and answers for it. Frames come with increasing index and time, all
  /// with the size, intrinsics and distortion of the first.
  /// A lost track is a state, not an error. Errors: kInvalidArgument for an empty or colour image,
  /// for a bad camera or one that changes, and for a frame not after the one before; kInternal when
  /// the estimator is gone for good (the run is CRASHED).
  [[nodiscard]] virtual Result<VoEstimate> track(const VoFrame& frame) = 0;
  /// Forgets every frame, as newly created; what set_debug said stays.
  virtual void reset() = 0;
  /// Whether `track` should make debug images and map points (they cost time). Default: no.
  virtual void set_debug(bool wanted) = 0;
  /// Lines that the estimator said since the last call, without line ends: what it logged, and what
  /// its process wrote. May be called from another thread than `track`.
  [[nodiscard]] virtual std::vector<std::string> take_log() { return {}; }
  /// Empty where nobody knows.
  /// May be called from another thread than `track`.
  [[nodiscard]] virtual std::optional<ResourceUse> resource_use() const { return std::nullopt; }
};

/// CRC-32 of the image's bytes, row by row, as zlib and PNG compute it: what the frames of several
/// estimators are compared by.
[[nodiscard]] std::uint32_t crc32_of(const Image& image);

/// Checks what every estimator asks of a frame; `previous` is the frame before, or null.
[[nodiscard]] Status validate_vo_frame(const VoFrame& frame, const VoFrame* previous);

}  // namespace overfly
