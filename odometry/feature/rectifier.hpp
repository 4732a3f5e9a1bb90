// Images as a pinhole of the same intrinsics would have taken them.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "core/camera_model.hpp"
#include "core/image.hpp"

namespace overfly::odometry {

/// Takes the lens out of images: all behind it works with the pinhole camera of the same size and
/// K. What the lens shows beyond the pinhole's image is lost; where it shows less than that (a
/// pincushion), the image is continued with its border, and `seen` is 0.
class Rectifier {
 public:
  explicit Rectifier(const CameraModel& camera);

  /// The image itself where there is no lens.
  [[nodiscard]] std::shared_ptr<const Image> rectify(std::shared_ptr<const Image> image) const;
  /// CV_8U: 255 where the rectified image shows what the lens saw; empty = everywhere.
  [[nodiscard]] const cv::Mat& seen() const { return seen_; }

 private:
  cv::Mat map_;  ///< CV_32FC2: place in the distorted image of each pixel; empty without a lens
  cv::Mat seen_;
};

}  // namespace overfly::odometry
