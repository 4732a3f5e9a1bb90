#include "renderer/camera/truth_images.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "renderer/camera/row_projector.hpp"

namespace overfly::renderer {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
constexpr double kHiddenShare = 0.01;
constexpr double kHiddenM = 0.3;

Eigen::Vector3d point_at(const PointImage& points, int x, int y) {
  const double* p = &points.at(x, y);
  return {p[0], p[1], p[2]};
}

/// Upward unit normal by central differences.
Eigen::Vector3d normal_at(const HeightQuery& ground, const Eigen::Vector3d& p, double step_m) {
  const double east = ground.ground_up_m(p.x() + step_m, p.y());
  const double west = ground.ground_up_m(p.x() - step_m, p.y());
  const double north = ground.ground_up_m(p.x(), p.y() + step_m);
  const double south = ground.ground_up_m(p.x(), p.y() - step_m);
  return Eigen::Vector3d((west - east) / (2.0 * step_m), (south - north) / (2.0 * step_m), 1.0)
      .normalized();
}

/// The farthest of the four depths around a position in the image: across a ridge the position
/// belongs to either side.
double farthest_depth_m(const DepthImage& depth, const Eigen::Vector2d& pixel) {
  const int x = std::clamp(static_cast<int>(pixel.x()), 0, depth.width_px - 1);
  const int y = std::clamp(static_cast<int>(pixel.y()), 0, depth.height_px - 1);
  const int right = std::min(x + 1, depth.width_px - 1);
  const int below = std::min(y + 1, depth.height_px - 1);
  return std::max({depth.at(x, y), depth.at(right, y), depth.at(x, below), depth.at(right, below)});
}

}  // namespace

PixelRays::PixelRays(const CameraModel& camera) : camera_(camera) {
  if (camera.distortion().none()) return;
  const PinholeCamera& pinhole = camera.pinhole();
  table_.reserve(static_cast<std::size_t>(pinhole.width_px) * pinhole.height_px);
  for (int y = 0; y < pinhole.height_px; ++y) {
    for (int x = 0; x < pinhole.width_px; ++x) {
      const auto ray = camera.ray(Eigen::Vector2d(x, y));
      table_.push_back(ray ? Eigen::Vector2d(ray->head<2>()) : Eigen::Vector2d(kNan, kNan));
    }
  }
}

Eigen::Vector3d PixelRays::at(int x, int y) const {
  if (table_.empty()) return camera_.pinhole().ray(Eigen::Vector2d(x, y));
  const Eigen::Vector2d& ray = table_[static_cast<std::size_t>(y) * camera_.pinhole().width_px +
                                      static_cast<std::size_t>(x)];
  return {ray.x(), ray.y(), 1.0};
}

DepthImage range_image(const PixelRays& rays, const DepthImage& depth) {
  DepthImage range(depth.width_px, depth.height_px, 1, std::numeric_limits<float>::infinity());
  for (int y = 0; y < depth.height_px; ++y) {
    for (int x = 0; x < depth.width_px; ++x) {
      const double metres = depth.at(x, y) * rays.at(x, y).norm();
      if (std::isfinite(metres)) range.at(x, y) = static_cast<float>(metres);
    }
  }
  return range;
}

PointImage world_points(const PixelRays& rays,
                        const CameraRequest& request,
                        const DepthImage& depth) {
  assert(depth.width_px == request.camera.pinhole().width_px);
  PointImage points(depth.width_px, depth.height_px, 3, kNan);
  const RowProjector rows(request);
  for (int y = 0; y < depth.height_px; ++y) {
    const Pose& T_world_camera = rows.T_world_camera(y);
    const Eigen::Matrix3d R_world_camera = T_world_camera.rotation.toRotationMatrix();
    for (int x = 0; x < depth.width_px; ++x) {
      const double z_m = depth.at(x, y);
      if (!std::isfinite(z_m)) continue;
      const Eigen::Vector3d p = R_world_camera * (z_m * rays.at(x, y)) + T_world_camera.translation;
      std::copy(p.data(), p.data() + 3, &points.at(x, y));
    }
  }
  return points;
}

VectorImage surface_normals(const PointImage& points,
                            const HeightQuery& ground,
                            const CameraRequest& request,
                            NormalFrame frame,
                            double step_m) {
  VectorImage normals(points.width_px, points.height_px, 3, kNanF);
  const RowProjector rows(request);
  for (int y = 0; y < points.height_px; ++y) {
    const Eigen::Matrix3d R_frame_world =
        frame == NormalFrame::kWorld
            ? Eigen::Matrix3d::Identity()
            : Eigen::Matrix3d(rows.T_world_camera(y).rotation.toRotationMatrix().transpose());
    for (int x = 0; x < points.width_px; ++x) {
      const Eigen::Vector3d p = point_at(points, x, y);
      if (!p.allFinite()) continue;
      const Eigen::Vector3d normal_world = normal_at(ground, p, step_m);
      const Eigen::Vector3f normal = (R_frame_world * normal_world).cast<float>();
      std::copy(normal.data(), normal.data() + 3, &normals.at(x, y));
    }
  }
  return normals;
}

VectorImage optical_flow(const PointImage& points,
                         const CameraRequest& other,
                         const DepthImage& other_depth) {
  VectorImage flow(points.width_px, points.height_px, 2, kNanF);
  const RowProjector projector(other);
  for (int y = 0; y < points.height_px; ++y) {
    for (int x = 0; x < points.width_px; ++x) {
      const Eigen::Vector3d p = point_at(points, x, y);
      if (!p.allFinite()) continue;
      const auto there = projector.project(p);
      if (!there || !projector.inside(there->pixel)) continue;
      const double seen_m = farthest_depth_m(other_depth, there->pixel);
      if (there->depth_m > seen_m * (1.0 + kHiddenShare) + kHiddenM) continue;
      flow.at(x, y, 0) = static_cast<float>(there->pixel.x() - x);
      flow.at(x, y, 1) = static_cast<float>(there->pixel.y() - y);
    }
  }
  return flow;
}

Image validity_mask(const PointImage& points, const terrain::TileSource& tiles) {
  Image mask(points.width_px, points.height_px, 1, kMaskNothing);
  // Same as terrain's drape_stretch(), which `overfly world info` uses.
  const double step_m = std::max(0.1, 0.25 * tiles.real_texel_m());
  for (int y = 0; y < points.height_px; ++y) {
    for (int x = 0; x < points.width_px; ++x) {
      const Eigen::Vector3d p = point_at(points, x, y);
      if (!p.allFinite()) continue;
      const Eigen::Vector2d map = tiles.map_from_world(p.x(), p.y());
      mask.at(x, y) = kMaskVoid;
      if (!tiles.has_imagery(map.x(), map.y())) continue;
      const bool steep = normal_at(tiles, p, step_m).z() < kSmearedNormalUp;
      mask.at(x, y) = steep ? kMaskSmeared : kMaskImagery;
    }
  }
  return mask;
}

}  // namespace overfly::renderer
