// How an image that is no plain pinhole picture is put together from pinhole pictures: rows that
// are exposed at different times, a lens, several samples a pixel.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera_model.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer {

/// A rectangle of the image and the pinhole picture from which it is sampled.
struct ImagePart {
  int left_px = 0;
  int top_px = 0;
  int width_px = 0;
  int height_px = 0;
  std::int64_t t_ns = 0;  ///< mid exposure of its middle row
  PinholeCamera source;   ///< of the picture
  Eigen::Matrix3d R_source_camera = Eigen::Matrix3d::Identity();
  /// True where the picture is the rectangle, pixel by pixel.
  bool direct = false;
  /// Added to the level of detail at which texels are sampled, at the picture's corners (left
  /// top, right top, left bottom, right bottom): so that they are as blurred as the image's pixels
  /// are large, not as the picture's are.
  std::array<float, 4> lod_bias{};
};

/// Divides an image into parts. Rows of one part are exposed at one time: `rows_a_part` says how
/// many. With a lens the parts are also small enough to look like pinhole pictures.
[[nodiscard]] std::vector<ImagePart> divide_image(const CameraRequest& request, int rows_a_part);

/// How many pictures a pixel's side is oversampled by a part that is not direct.
inline constexpr double kOversampling = 2.0;

/// The places in an image's pixel, relative to its centre, whose mean it is: one, or four at
/// +-1/4 px.
[[nodiscard]] std::vector<Eigen::Vector2d> pixel_taps(RenderQuality quality);

/// A pinhole camera with the same focal length that sees all rays of a camera, up to 80 deg off
/// its axis.
[[nodiscard]] PinholeCamera covering_pinhole(const CameraModel& camera);

/// Where a ray of the camera meets a part's picture [px].
[[nodiscard]] Eigen::Vector2d source_pixel(const ImagePart& part, const Eigen::Vector3d& ray);

}  // namespace overfly::renderer
