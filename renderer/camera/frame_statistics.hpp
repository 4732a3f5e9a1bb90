// Statistics of a camera frame about its imagery.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "renderer/ground/ground_mesh.hpp"

namespace overfly::renderer {

/// Rays of a frame that its statistics are measured on.
inline constexpr int kMeasureColumns = 40;
inline constexpr int kMeasureRows = 30;

struct FrameStatistics {
  double texels_per_pixel_min = 0.0;
  double texels_per_pixel_median = 0.0;
  double void_fraction = 0.0;
  std::optional<double> axis_depth_m;
};

/// Statistics from the rays that met the ground; the axis depth stays empty.
/// @param texels_per_px  of level 0, of each ray that met imagery; the statistics count texels of
///     tiles.real_texel_m(), because levels finer than the photograph are synthetic
/// @param void_rays  number of rays that met ground without imagery
[[nodiscard]] FrameStatistics statistics_of_rays(std::vector<double> texels_per_px,
                                                 int void_rays,
                                                 const terrain::TileSource& tiles);

/// True where a textured tile has imagery at texture coordinates (u, v).
using ImageryQuery = std::function<bool(const terrain::TileId& tile, double u, double v)>;

/// Queries the tile source. @param tiles  must outlive the query
[[nodiscard]] ImageryQuery imagery_query(const terrain::TileSource& tiles);

/// Measures a frame on a grid of 40 x 30 rays through the drawn mesh, one at the centre of each
/// 1/40 x 1/30 of the image: void_fraction has a step of 1/1200, and the minimum may miss details
/// smaller than a cell. Texels per pixel are the root of their number per pixel area. The axis
/// depth is refined on the ground itself (to 1 mm).
/// @param mesh  of a view that sees all rays of the camera (covering_pinhole)
/// @param camera  whose pixels are counted
/// @pre all triangles face the camera, as build_ground_mesh ensures
[[nodiscard]] FrameStatistics measure_frame(const GroundMesh& mesh,
                                            const View& view,
                                            const CameraModel& camera,
                                            const terrain::TileSource& tiles,
                                            const ImageryQuery& has_imagery);

}  // namespace overfly::renderer
