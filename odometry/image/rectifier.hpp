// Converts images into those of a pinhole camera with the same intrinsics.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"

namespace overfly::odometry {

/// Removes lens distortion, so that all later stages use the pinhole camera of the same size and K.
/// Parts of the image outside the pinhole's view are lost. If the lens covers less than the
/// pinhole's view (pincushion), the border is replicated and `seen` is 0 there.
class Rectifier {
 public:
  explicit Rectifier(const CameraModel& camera);

  /// Returns the image itself if there is no distortion.
  [[nodiscard]] std::shared_ptr<const Image> rectify(std::shared_ptr<const Image> image) const;
  /// CV_8U: 255 where the rectified image has data from the lens; empty = everywhere.
  [[nodiscard]] const cv::Mat& seen() const { return seen_; }

 private:
  cv::Mat map_;  ///< CV_32FC2: distorted position of each pixel; empty without distortion
  cv::Mat seen_;
};

}  // namespace overfly::odometry
