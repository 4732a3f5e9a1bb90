#include "renderer/camera/image_parts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/algebra/decompositions.hpp"
#include "core/motion/pose.hpp"

namespace overfly::renderer {

namespace {

/// Maximum part size with a lens, small enough that its pinhole image is hardly stretched at the
/// rim.
constexpr int kLensPartPx = 256;
/// Margin around a part's pinhole image for the taps' neighbours [px].
constexpr double kMarginPx = 4.0;

/// Points on the rim and inside a part's rectangle at which a lens is evaluated.
std::vector<Eigen::Vector2d> probe_pixels(const ImagePart& part) {
  constexpr int kSteps = 8;
  std::vector<Eigen::Vector2d> pixels;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      pixels.emplace_back(part.left_px - 0.5 + part.width_px * static_cast<double>(i) / kSteps,
                          part.top_px - 0.5 + part.height_px * static_cast<double>(j) / kSteps);
    }
  }
  return pixels;
}

/// The singular values of d(plane of the part's picture) / d(pixel), largest first.
std::optional<Eigen::Vector2d> plane_per_pixel(const CameraModel& camera,
                                               const Eigen::Matrix3d& R_source_camera,
                                               const Eigen::Vector2d& pixel) {
  constexpr double kStepPx = 0.5;
  const auto plane = [&](const Eigen::Vector2d& at) -> std::optional<Eigen::Vector2d> {
    const std::optional<Eigen::Vector3d> ray = camera.ray(at);
    if (!ray) return std::nullopt;
    const Eigen::Vector3d p = R_source_camera * *ray;
    if (!(p.z() > 0.05 * p.norm())) return std::nullopt;
    return Eigen::Vector2d(p.head<2>() / p.z());
  };
  Eigen::Matrix2d J;
  for (int axis = 0; axis < 2; ++axis) {
    Eigen::Vector2d step = Eigen::Vector2d::Zero();
    step[axis] = kStepPx;
    const auto before = plane(pixel - step);
    const auto after = plane(pixel + step);
    if (!before || !after) return std::nullopt;
    J.col(axis) = (*after - *before) / (2.0 * kStepPx);
  }
  return singular_values(J);
}

/// A pinhole image of the rays through a part's rectangle, looking at its centre.
void aim_through_lens(const CameraModel& camera, double lod_shift, ImagePart& part) {
  const Eigen::Vector2d middle(part.left_px + 0.5 * (part.width_px - 1),
                               part.top_px + 0.5 * (part.height_px - 1));
  const Eigen::Vector3d axis = camera.ray(middle).value_or(Eigen::Vector3d::UnitZ());
  part.R_source_camera = shortest_rotation(axis, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Eigen::AlignedBox2d box;
  double finest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& pixel : probe_pixels(part)) {
    const std::optional<Eigen::Vector3d> ray = camera.ray(pixel);
    const auto scale = plane_per_pixel(camera, part.R_source_camera, pixel);
    if (!ray || !scale) continue;
    const Eigen::Vector3d p = part.R_source_camera * *ray;
    box.extend(Eigen::Vector2d(p.head<2>() / p.z()));
    finest = std::min(finest, scale->y());
  }
  PinholeCamera& source = part.source;
  source.fx_px = source.fy_px = kOversampling / finest;
  const Eigen::Vector2d low = source.fx_px * box.min() - Eigen::Vector2d::Constant(kMarginPx);
  const Eigen::Vector2d high = source.fx_px * box.max() + Eigen::Vector2d::Constant(kMarginPx);
  source.cx_px = -std::floor(low.x());
  source.cy_px = -std::floor(low.y());
  source.width_px = static_cast<int>(std::ceil(high.x() - std::floor(low.x())));
  source.height_px = static_cast<int>(std::ceil(high.y() - std::floor(low.y())));
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d corner(part.left_px - 0.5 + (i & 1) * part.width_px,
                                 part.top_px - 0.5 + (i >> 1) * part.height_px);
    const auto scale = plane_per_pixel(camera, part.R_source_camera, corner);
    const double source_px = source.fx_px * (scale ? scale->x() : finest);
    part.lod_bias[i] = static_cast<float>(std::log2(source_px) + lod_shift);
  }
}

/// Rows of the image at the original or `scale` times the density.
void aim_straight(const PinholeCamera& camera, int scale, ImagePart& part) {
  PinholeCamera& source = part.source;
  source.width_px = scale * part.width_px;
  source.height_px = scale * part.height_px;
  source.fx_px = scale * camera.fx_px;
  source.fy_px = scale * camera.fy_px;
  // Pixel edges coincide: position + 0.5 scales.
  source.cx_px = scale * (camera.cx_px - part.left_px + 0.5) - 0.5;
  source.cy_px = scale * (camera.cy_px - part.top_px + 0.5) - 0.5;
  part.direct = scale == 1;
}

}  // namespace

std::vector<ImagePart> divide_image(const CameraRequest& request, int rows_a_part) {
  const PinholeCamera& camera = request.camera.pinhole();
  const bool lens = !request.camera.distortion().none();
  const bool reference = request.quality == RenderQuality::kReference;
  const int height = lens ? std::min(rows_a_part, kLensPartPx) : rows_a_part;
  const int width = lens ? kLensPartPx : camera.width_px;
  std::vector<ImagePart> parts;
  for (int top = 0; top < camera.height_px; top += height) {
    for (int left = 0; left < camera.width_px; left += width) {
      ImagePart part;
      part.left_px = left;
      part.top_px = top;
      part.width_px = std::min(width, camera.width_px - left);
      part.height_px = std::min(height, camera.height_px - top);
      part.t_ns = request.row_time_ns(top + 0.5 * (part.height_px - 1));
      if (lens) {
        aim_through_lens(request.camera, reference ? -1.0 : 0.0, part);
      } else {
        aim_straight(camera, reference ? 2 : 1, part);
      }
      parts.push_back(part);
    }
  }
  return parts;
}

std::vector<Eigen::Vector2d> pixel_taps(RenderQuality quality) {
  if (quality == RenderQuality::kTrilinear) return {{0.0, 0.0}};
  return {{-0.25, -0.25}, {0.25, -0.25}, {-0.25, 0.25}, {0.25, 0.25}};
}

PinholeCamera covering_pinhole(const CameraModel& camera) {
  if (camera.distortion().none()) return camera.pinhole();
  PinholeCamera wide = camera.pinhole();
  constexpr double kFarthest = 5.67;  // tan 80 deg
  Eigen::AlignedBox2d box;
  ImagePart whole;
  whole.width_px = wide.width_px;
  whole.height_px = wide.height_px;
  for (const Eigen::Vector2d& pixel : probe_pixels(whole)) {
    if (const auto ray = camera.ray(pixel)) {
      box.extend(ray->head<2>().cwiseMax(-kFarthest).cwiseMin(kFarthest));
    }
  }
  // Margin, because a lens may bulge slightly between the probed points.
  const Eigen::Vector2d focal(wide.fx_px, wide.fy_px);
  const Eigen::Vector2d margin = 0.02 * focal.cwiseProduct(box.sizes());
  const Eigen::Vector2d low = focal.cwiseProduct(box.min()) - margin;
  const Eigen::Vector2d high = focal.cwiseProduct(box.max()) + margin;
  wide.cx_px = -low.x();
  wide.cy_px = -low.y();
  wide.width_px = static_cast<int>(std::ceil(high.x() - low.x()));
  wide.height_px = static_cast<int>(std::ceil(high.y() - low.y()));
  return wide;
}

Eigen::Vector2d source_pixel(const ImagePart& part, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d p = part.R_source_camera * ray;
  return {part.source.fx_px * p.x() / p.z() + part.source.cx_px,
          part.source.fy_px * p.y() / p.z() + part.source.cy_px};
}

}  // namespace overfly::renderer
