// What a camera of an aircraft sees of the ground at an instant, by a grid of its pixels.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "core/camera/camera_model.hpp"
#include "core/motion/pose.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::server {

/// Pixels of the grid along a side of the image; each is the centre of 1/5 x 1/5 of it.
inline constexpr std::size_t kViewGrid = 5;
inline constexpr std::size_t kViewPoints = kViewGrid * kViewGrid;

/// A pixel and where its ray meets the ground.
struct ViewPoint {
  Eigen::Vector2d pixel{0.0, 0.0};
  Eigen::Vector3d ray_camera{0.0, 0.0, 1.0};    ///< z = 1
  std::optional<Eigen::Vector3d> ground_world;  ///< empty for a ray to the sky or far away
};

struct CameraView {
  Pose T_world_camera;
  std::array<ViewPoint, kViewPoints> points;
};

/// @pre the camera is valid
[[nodiscard]] CameraView view_of(const CameraModel& camera,
                                 const Pose& T_world_camera,
                                 const terrain::TileSource& tiles);

/// Median over the grid of the imagery's texels per pixel, as the root of their number per pixel
/// area on level ground. Empty if no ray meets the ground.
[[nodiscard]] std::optional<double> texels_per_pixel(const CameraModel& camera,
                                                     const CameraView& view,
                                                     double texel_m);
/// Share of the grid's points over imagery.
[[nodiscard]] double imagery_share(const CameraView& view, const terrain::TileSource& tiles);

/// The ground's quadrilateral in an image, between the rays of its corners, clockwise from the
/// upper left one.
using GroundQuad = std::array<Eigen::Vector3d, 4>;

/// Share of the area of one convex quadrilateral that lies in another one, seen from above.
/// Method: Sutherland, Hodgman (1974), "Reentrant Polygon Clipping", CACM 17(1).
[[nodiscard]] double overlap_of(const GroundQuad& first, const GroundQuad& second);

/// Empty if one of the corners' rays does not meet the ground nearby.
[[nodiscard]] std::optional<GroundQuad> footprint_of(const CameraModel& camera,
                                                     const Pose& T_world_camera,
                                                     const terrain::TileSource& tiles);

/// Motion of the image between a view and the next one [px]: RMS over the grid.
struct PixelMotion {
  double rotation_px = 0.0;     ///< by the camera's rotation alone
  double translation_px = 0.0;  ///< by its translation, after the rotation
};
[[nodiscard]] PixelMotion motion_of(const CameraModel& camera,
                                    const CameraView& view,
                                    const Pose& T_world_next);

}  // namespace overfly::server
