#include "renderer/raycast/frame_measure.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "renderer/ground/ground_ray.hpp"
#include "renderer/raycast/block_builder.hpp"
#include "renderer/raycast/block_places.hpp"

namespace overfly::renderer::raycast {

namespace {

/// The depth on the optical axis.
std::optional<double> cast_axis_depth(const Pose& T_world_camera,
                                      const GroundCaster& caster,
                                      const HeightQuery& ground) {
  const RowPose pose = RowPose::of(T_world_camera);
  const Eigen::Vector3d axis = pose.R_world_camera.col(2);
  const GroundHit hit = caster.cast(pose.position, axis, 0.0);
  if (hit.sky()) return std::nullopt;
  return refine_depth(ground, pose.position, axis, hit.depth);
}

/// The measurements of one row of rays.
struct RowMeasure {
  std::vector<double> texels;
  int void_rays = 0;
};

}  // namespace

FrameStatistics measure_rays(const CameraModel& camera,
                             const ShutterPoses& poses,
                             const Pose& T_world_camera,
                             const GroundCaster& caster,
                             const terrain::TileSource& tiles,
                             const ImageryAt& has_imagery,
                             WorkerPool& pool) {
  const PinholeCamera& size = camera.pinhole();
  std::array<RowMeasure, kMeasureRows> rows;
  pool.run(kMeasureRows, [&](int row) {
    RowMeasure& seen = rows[row];
    const double y_px = (row + 0.5) * size.height_px / kMeasureRows - 0.5;
    const RowPose& pose = poses.at(std::floor(2.0 * y_px) / 2.0);
    GroundHit last;
    for (int column = 0; column < kMeasureColumns; ++column) {
      const double x_px = (column + 0.5) * size.width_px / kMeasureColumns - 0.5;
      const auto ray = camera.ray({x_px, y_px});
      const auto right = camera.ray({x_px + 0.5, y_px}), left = camera.ray({x_px - 0.5, y_px});
      const auto down = camera.ray({x_px, y_px + 0.5}), up = camera.ray({x_px, y_px - 0.5});
      if (!ray || !right || !left || !down || !up) continue;
      const GroundHit hit =
          caster.cast(pose.position, pose.R_world_camera * *ray, last.depth, last.node);
      last = hit;
      if (hit.sky()) continue;
      const Eigen::Matrix2d J = texel_jacobian(
          hit, pose, ray->head<2>(), (*right - *left).head<2>(), (*down - *up).head<2>());
      const Eigen::Vector2d at = hit.texel();
      if (has_imagery(at.x(), at.y(), texel_lod(J(0, 0), J(1, 0), J(0, 1), J(1, 1)))) {
        seen.texels.push_back(std::sqrt(std::abs(J.determinant())));
      } else {
        ++seen.void_rays;
      }
    }
  });
  std::vector<double> texels;
  int void_rays = 0;
  for (const RowMeasure& row : rows) {
    texels.insert(texels.end(), row.texels.begin(), row.texels.end());
    void_rays += row.void_rays;
  }
  FrameStatistics statistics = statistics_of_rays(std::move(texels), void_rays, tiles);
  statistics.axis_depth_m = cast_axis_depth(T_world_camera, caster, tiles);
  return statistics;
}

}  // namespace overfly::renderer::raycast
