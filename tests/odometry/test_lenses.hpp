// Small cameras with lenses.
#pragma once

#include <array>
#include <opencv2/core.hpp>

#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"

namespace overfly::odometry::testing {

inline Distortion lens(DistortionModel model, std::array<double, 5> k) { return {model, k}; }

/// A barrel, as cheap wide-angle lenses have.
inline Distortion barrel() {
  return lens(DistortionModel::kRadtan, {-0.22, 0.06, 4e-4, -3e-4, 0.0});
}
/// A pincushion: the pinhole's corners lie outside the lens's image.
inline Distortion pincushion() {
  return lens(DistortionModel::kRadtan, {0.12, 0.02, 0.0, 0.0, 0.0});
}
inline Distortion atan_lens() { return lens(DistortionModel::kFov, {0.9, 0.0, 0.0, 0.0, 0.0}); }

inline PinholeCamera small_camera() {
  return PinholeCamera::from_fov(320, 240, rad_from_deg(84.872), FovAxis::kHorizontal).value();
}

inline cv::Mat mat_of(const Image& image) {
  auto* data = const_cast<std::uint8_t*>(image.data.data());
  return cv::Mat(image.height_px, image.width_px, CV_8U, data).clone();
}

}  // namespace overfly::odometry::testing
