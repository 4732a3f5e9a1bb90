// Ground truth of every pixel of a camera image: range, world position, surface normal, motion to
// another image, validity. Pure functions of the depth image and the rendered requests.
//
// Pixels that see no ground (sky, or no ray through the lens) are NaN in every image except range,
// where they are +infinity as in the depth image, and the mask, where they are 0.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/camera/image.hpp"
#include "core/earth/height_query.hpp"
#include "renderer/renderer.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::renderer {

/// World coordinates, 3 channels: east, north, up [m]. Double: a float has steps of 8 mm at 100 km.
using PointImage = ImageBuffer<double>;
/// Normals (3 channels) or pixel motions (2 channels: right, down [px]).
using VectorImage = ImageBuffer<float>;

/// The direction of every pixel of a camera, computed once, because a lens needs an iteration for
/// each.
class PixelRays {
 public:
  explicit PixelRays(const CameraModel& camera);

  /// Direction with z = 1 through a pixel's centre, camera frame; NaN if the lens has none.
  [[nodiscard]] Eigen::Vector3d at(int x, int y) const;

 private:
  CameraModel camera_;
  std::vector<Eigen::Vector2d> table_;  ///< x and y; empty for a pinhole
};

/// The frame in which normals are expressed.
enum class NormalFrame {
  kWorld,   ///< east-north-up
  kCamera,  ///< right-down-forward, of the pixel's row
};

/// Values of the validity mask.
inline constexpr std::uint8_t kMaskNothing = 0;  ///< sky, or no ray
inline constexpr std::uint8_t kMaskVoid = 128;   ///< ground without imagery
/// Ground whose imagery is smeared because it is too steep to be photographed from above: beyond 60
/// deg a texel is stretched to more than twice its length.
inline constexpr std::uint8_t kMaskSmeared = 192;
inline constexpr double kSmearedNormalUp = 0.5;    ///< cosine of that slope
inline constexpr std::uint8_t kMaskImagery = 255;  ///< ground with imagery

/// Distance from the camera to the ground along each pixel's ray [m]: depth * |ray|.
[[nodiscard]] DepthImage range_image(const PixelRays& rays, const DepthImage& depth);

/// The ground's point at each pixel: T_world_camera(time of the pixel's row) * (depth * ray).
/// @pre rays and depth are those of the request's camera
[[nodiscard]] PointImage world_points(const PixelRays& rays,
                                      const CameraRequest& request,
                                      const DepthImage& depth);

/// Unit normals of the ground, upwards in the world: (-dh/de, -dh/dn, 1) normalised, from central
/// differences of the height h over `step_m` on either side.
/// Cost: four height queries per pixel.
[[nodiscard]] VectorImage surface_normals(const PointImage& points,
                                          const HeightQuery& ground,
                                          const CameraRequest& request,
                                          NormalFrame frame,
                                          double step_m = 0.5);

/// Motion of each pixel's ground point to its position in another image of a camera, of the same or
/// another time: other position = pixel + flow. NaN if that position is outside the image, behind
/// the camera, or occluded by nearer ground (by more than 1 % of its depth and 0.3 m).
/// @param other  the request of that image; its rows are solved for (RowProjector)
/// @param other_depth  depth image of that request
[[nodiscard]] VectorImage optical_flow(const PointImage& points,
                                       const CameraRequest& other,
                                       const DepthImage& other_depth);

/// One channel of kMaskNothing, kMaskVoid, kMaskSmeared, kMaskImagery.
/// Cost: four height queries per pixel.
[[nodiscard]] Image validity_mask(const PointImage& points, const terrain::TileSource& tiles);

}  // namespace overfly::renderer
