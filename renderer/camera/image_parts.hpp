// Composes an image from pinhole images, as needed for rows exposed at different times, a lens, or
// several samples per pixel.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer {

/// A rectangle of the image and the pinhole image from which it is sampled.
struct ImagePart {
  int left_px = 0;
  int top_px = 0;
  int width_px = 0;
  int height_px = 0;
  std::int64_t t_ns = 0;  ///< mid exposure of its middle row
  PinholeCamera source;   ///< of the pinhole image
  Eigen::Matrix3d R_source_camera = Eigen::Matrix3d::Identity();
  /// True if the pinhole image is the rectangle, pixel by pixel.
  bool direct = false;
  /// Added to the level of detail at which texels are sampled, at the pinhole image's corners (left
  /// top, right top, left bottom, right bottom), so that the blur matches the pixels of the final
  /// image instead of those of the pinhole image.
  std::array<float, 4> lod_bias{};
};

/// Divides an image into parts. Rows of one part are exposed at the same time: `rows_a_part` gives
/// their number. With a lens the parts are also small enough to be approximated by pinhole images.
[[nodiscard]] std::vector<ImagePart> divide_image(const CameraRequest& request, int rows_a_part);

/// Linear oversampling of a part that is not direct.
inline constexpr double kOversampling = 2.0;

/// Sample positions in an image's pixel, relative to its centre, whose mean is the pixel: one, or
/// four at +-1/4 px.
[[nodiscard]] std::vector<Eigen::Vector2d> pixel_taps(RenderQuality quality);

/// A pinhole camera with the same focal length that covers all rays of a camera, up to 80 deg off
/// its axis.
[[nodiscard]] PinholeCamera covering_pinhole(const CameraModel& camera);

/// Position of a ray of the camera in a part's pinhole image [px].
[[nodiscard]] Eigen::Vector2d source_pixel(const ImagePart& part, const Eigen::Vector3d& ray);

}  // namespace overfly::renderer
