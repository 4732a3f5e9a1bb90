#include "renderer/camera/part_sampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "renderer/camera/cubic_weights.hpp"

namespace overfly::renderer {

namespace {

/// Closer to a pixel's centre than this, the pixel's value is used directly.
constexpr double kOnCentrePx = 1e-6;

/// Adds the interpolated value at a position to `sums`.
void add_sample(const ImageBuffer<float>& picture,
                const Eigen::Vector2d& at,
                std::array<float, 3>& sums) {
  const Eigen::Vector2d nearest(std::round(at.x()), std::round(at.y()));
  const auto clamped_x = [&](int x) { return std::clamp(x, 0, picture.width_px - 1); };
  const auto clamped_y = [&](int y) { return std::clamp(y, 0, picture.height_px - 1); };
  if ((at - nearest).cwiseAbs().maxCoeff() < kOnCentrePx) {
    const int x = clamped_x(static_cast<int>(nearest.x()));
    const int y = clamped_y(static_cast<int>(nearest.y()));
    for (int c = 0; c < picture.channels; ++c) sums[c] += picture.at(x, y, c);
    return;
  }
  const double left = std::floor(at.x());
  const double top = std::floor(at.y());
  const std::array<float, 4> weights_x = cubic_weights<float>(at.x() - left);
  const std::array<float, 4> weights_y = cubic_weights<float>(at.y() - top);
  std::array<float, 3> value{};
  for (int j = 0; j < 4; ++j) {
    const int y = clamped_y(static_cast<int>(top) - 1 + j);
    for (int i = 0; i < 4; ++i) {
      const float weight = weights_x[i] * weights_y[j];
      const float* texel = &picture.at(clamped_x(static_cast<int>(left) - 1 + i), y);
      for (int c = 0; c < picture.channels; ++c) value[c] += weight * texel[c];
    }
  }
  // The kernel overshoots at edges; light is never negative.
  for (int c = 0; c < picture.channels; ++c) sums[c] += std::max(value[c], 0.0F);
}

/// Interpolated depth at a position, through 1 / z, which is affine over a plane's image.
float depth_at(const DepthImage& picture, const Eigen::Vector2d& at) {
  const int left = std::clamp(static_cast<int>(std::floor(at.x())), 0, picture.width_px - 1);
  const int top = std::clamp(static_cast<int>(std::floor(at.y())), 0, picture.height_px - 1);
  const int right = std::min(left + 1, picture.width_px - 1);
  const int bottom = std::min(top + 1, picture.height_px - 1);
  const std::array<float, 4> z{picture.at(left, top),
                               picture.at(right, top),
                               picture.at(left, bottom),
                               picture.at(right, bottom)};
  const auto [nearest, farthest] = std::minmax_element(z.begin(), z.end());
  const double fx = std::clamp(at.x() - left, 0.0, 1.0);
  const double fy = std::clamp(at.y() - top, 0.0, 1.0);
  constexpr float kEdgeRatio = 1.02F;
  if (!std::isfinite(*farthest) || *farthest > kEdgeRatio * *nearest) {
    return picture.at(fx < 0.5 ? left : right, fy < 0.5 ? top : bottom);
  }
  const double inverse =
      (1.0 - fy) * ((1.0 - fx) / z[0] + fx / z[1]) + fy * ((1.0 - fx) / z[2] + fx / z[3]);
  return static_cast<float>(1.0 / inverse);
}

}  // namespace

TapRays::TapRays(const CameraModel& camera, RenderQuality quality)
    : camera_(camera), quality_(quality), taps_(pixel_taps(quality)) {
  if (camera.distortion().none()) return;
  const PinholeCamera& size = camera.pinhole();
  plane_.reserve(static_cast<std::size_t>(size.width_px) * size.height_px * taps_.size());
  for (int y = 0; y < size.height_px; ++y) {
    for (int x = 0; x < size.width_px; ++x) {
      for (const Eigen::Vector2d& tap : taps_) {
        const auto ray = camera.ray(Eigen::Vector2d(x, y) + tap);
        plane_.push_back(ray ? Eigen::Vector2f(ray->head<2>().cast<float>())
                             : Eigen::Vector2f::Constant(std::nanf("")));
      }
    }
  }
}

bool TapRays::fits(const CameraModel& camera, RenderQuality quality) const {
  return quality == quality_ && camera == camera_;
}

Eigen::Vector3d TapRays::ray(int x, int y, int tap) const {
  if (plane_.empty()) return camera_.pinhole().ray(Eigen::Vector2d(x, y) + taps_[tap]);
  const std::size_t pixel = static_cast<std::size_t>(y) * camera_.pinhole().width_px + x;
  const Eigen::Vector2f& plane = plane_[pixel * taps_.size() + tap];
  return {plane.x(), plane.y(), 1.0};
}

void add_part(const ImagePart& part,
              const ImageBuffer<float>& picture,
              const TapRays& rays,
              float weight,
              ImageBuffer<float>& image) {
  const float tap_weight = weight / static_cast<float>(rays.taps());
  for (int y = 0; y < part.height_px; ++y) {
    float* to = &image.at(part.left_px, part.top_px + y);
    if (part.direct) {
      const float* from = &picture.at(0, y);
      for (int i = 0; i < part.width_px * image.channels; ++i) to[i] += weight * from[i];
      continue;
    }
    for (int x = 0; x < part.width_px; ++x, to += image.channels) {
      std::array<float, 3> sums{};
      for (int tap = 0; tap < rays.taps(); ++tap) {
        const Eigen::Vector3d ray = rays.ray(part.left_px + x, part.top_px + y, tap);
        if (!std::isnan(ray.x())) add_sample(picture, source_pixel(part, ray), sums);
      }
      for (int c = 0; c < image.channels; ++c) to[c] += tap_weight * sums[c];
    }
  }
}

void write_depth(const ImagePart& part,
                 const DepthImage& picture,
                 const TapRays& rays,
                 DepthImage& depth) {
  for (int y = 0; y < part.height_px; ++y) {
    for (int x = 0; x < part.width_px; ++x) {
      float& to = depth.at(part.left_px + x, part.top_px + y);
      if (part.direct) {
        to = picture.at(x, y);
        continue;
      }
      const Eigen::Vector3d ray = rays.ray(part.left_px + x, part.top_px + y, 0);
      to = std::numeric_limits<float>::infinity();
      if (std::isnan(ray.x())) continue;
      // The point is both at z_picture along the pinhole image's axis and at z_camera times the
      // ray.
      const double along = (part.R_source_camera * ray).z();
      to = static_cast<float>(depth_at(picture, source_pixel(part, ray)) / along);
    }
  }
}

}  // namespace overfly::renderer
