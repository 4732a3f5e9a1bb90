#include "odometry/image/rectifier.hpp"

#include <opencv2/imgproc.hpp>

namespace overfly::odometry {

Rectifier::Rectifier(const CameraModel& camera) {
  if (camera.distortion().none()) return;
  const PinholeCamera& pinhole = camera.pinhole();
  map_.create(pinhole.height_px, pinhole.width_px, CV_32FC2);
  cv::Mat seen(map_.size(), CV_8U, cv::Scalar(0));
  for (int y = 0; y < map_.rows; ++y) {
    for (int x = 0; x < map_.cols; ++x) {
      const auto place = camera.project(pinhole.ray(Eigen::Vector2d(x, y)));
      if (!place) {
        map_.at<cv::Vec2f>(y, x) = cv::Vec2f(0.0F, 0.0F);
        continue;
      }
      map_.at<cv::Vec2f>(y, x) =
          cv::Vec2f(static_cast<float>(place->x()), static_cast<float>(place->y()));
      if (place->x() >= 0.0 && place->y() >= 0.0 && place->x() <= pinhole.width_px - 1 &&
          place->y() <= pinhole.height_px - 1) {
        seen.at<std::uint8_t>(y, x) = 255;
      }
    }
  }
  if (cv::countNonZero(seen) < seen.rows * seen.cols) seen_ = seen;
}

std::shared_ptr<const Image> Rectifier::rectify(std::shared_ptr<const Image> image) const {
  if (map_.empty()) return image;
  // cv::Mat cannot refer to constant data; nothing here writes to it.
  auto* data = const_cast<std::uint8_t*>(image->data.data());
  const cv::Mat distorted(image->height_px, image->width_px, CV_8U, data);
  auto rectified = std::make_shared<Image>(image->width_px, image->height_px, 1);
  cv::Mat target(distorted.size(), CV_8U, rectified->data.data());
  cv::remap(distorted, target, map_, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return rectified;
}

}  // namespace overfly::odometry
