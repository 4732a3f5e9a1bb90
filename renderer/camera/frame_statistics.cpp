#include "renderer/camera/frame_statistics.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "renderer/ground/ground_ray.hpp"

namespace overfly::renderer {

namespace {

/// The nearest ground on one ray.
struct Hit {
  double depth_m = std::numeric_limits<double>::infinity();
  double u = 0.0, v = 0.0;
  double texels_per_px = 0.0;
  const GroundBatch* batch = nullptr;
};

/// A triangle in the form used for intersection with rays from the optical centre.
class SeenTriangle {
 public:
  SeenTriangle(const GroundVertex& a, const GroundVertex& b, const GroundVertex& c)
      : vertices_{&a, &b, &c} {
    for (int i = 0; i < 3; ++i) p_[i] = {vertices_[i]->x, vertices_[i]->y, vertices_[i]->z};
    for (int i = 0; i < 3; ++i) edge_normals_[i] = p_[(i + 1) % 3].cross(p_[(i + 2) % 3]);
    const Eigen::Vector3d normal = (p_[1] - p_[0]).cross(p_[2] - p_[0]);
    doubled_area_m2_ = normal.norm();
    normal_ = normal;
    offset_ = normal.dot(p_[0]);
  }

  [[nodiscard]] double doubled_area_m2() const { return doubled_area_m2_; }
  /// Doubled area in texels of the tile's own level.
  [[nodiscard]] double doubled_area_texels() const {
    const auto [a, b, c] = vertices_;
    return std::abs((b->u - a->u) * (c->v - a->v) - (c->u - a->u) * (b->v - a->v)) *
           terrain::kTileSide * terrain::kTileSide;
  }

  /// @param ray  direction with z = 1
  [[nodiscard]] bool intersect(const Eigen::Vector3d& ray, Hit& hit) const {
    const std::array<double, 3> weights = {
        edge_normals_[0].dot(ray), edge_normals_[1].dot(ray), edge_normals_[2].dot(ray)};
    // If the triangle faces the camera, its edge normals point away from the rays inside.
    if (weights[0] > 0.0 || weights[1] > 0.0 || weights[2] > 0.0) return false;
    const double sum = weights[0] + weights[1] + weights[2];
    const double along = normal_.dot(ray);
    if (sum == 0.0 || along == 0.0) return false;
    const double depth_m = offset_ / along;
    if (depth_m <= 0.0 || depth_m >= hit.depth_m) return false;
    hit.depth_m = depth_m;
    hit.u = hit.v = 0.0;
    for (int i = 0; i < 3; ++i) {
      hit.u += weights[i] / sum * vertices_[i]->u;
      hit.v += weights[i] / sum * vertices_[i]->v;
    }
    // Surface area seen per unit area of the image plane at z = 1: depth^3 / distance of the plane.
    hit.texels_per_px = depth_m * depth_m * depth_m * doubled_area_m2_ / std::abs(offset_);
    return true;
  }

  [[nodiscard]] const std::array<Eigen::Vector3d, 3>& points() const { return p_; }

 private:
  std::array<const GroundVertex*, 3> vertices_;
  std::array<Eigen::Vector3d, 3> p_, edge_normals_;
  Eigen::Vector3d normal_;
  double doubled_area_m2_ = 0.0;
  double offset_ = 0.0;
};

/// The grid of rays over the image.
class SampleGrid {
 public:
  SampleGrid(const View& view, const CameraModel& camera) : view_(view), camera_(camera) {
    for (int row = 0; row < kMeasureRows; ++row) {
      for (int column = 0; column < kMeasureColumns; ++column) add_ray(pixel(column, row));
    }
  }

  void add(const SeenTriangle& triangle, const GroundBatch& batch) {
    const double texels = triangle.doubled_area_texels() * std::ldexp(1.0, 2 * batch.texture.level);
    const double scale = texels / triangle.doubled_area_m2();
    const auto test = [&](std::size_t i) {
      const Ray& ray = rays_[i];
      if (!triangle.intersect(ray.direction, hits_[i])) return;
      hits_[i].texels_per_px = std::sqrt(hits_[i].texels_per_px * scale * ray.plane_area_per_px);
      hits_[i].batch = &batch;
    };
    if (!camera_.distortion().none()) {
      // The rays do not form a grid in the plane, so each is examined.
      Eigen::AlignedBox2d box;
      bool in_front = true;
      for (const Eigen::Vector3d& p : triangle.points()) {
        in_front = in_front && p.z() > 0.0;
        box.extend(Eigen::Vector2d(p.head<2>() / p.z()));
      }
      for (std::size_t i = 0; i < rays_.size(); ++i) {
        if (!in_front || box.contains(rays_[i].direction.head<2>())) test(i);
      }
      return;
    }
    int left = 0, right = kMeasureColumns - 1, top = 0, bottom = kMeasureRows - 1;
    bound(triangle, left, right, top, bottom);
    for (int row = top; row <= bottom; ++row) {
      for (int column = left; column <= right; ++column) {
        test(static_cast<std::size_t>(row) * kMeasureColumns + column);
      }
    }
  }

  [[nodiscard]] const std::vector<Hit>& hits() const { return hits_; }

 private:
  struct Ray {
    Eigen::Vector3d direction;       // z = 1
    double plane_area_per_px = 0.0;  // of the plane z = 1
  };

  void add_ray(const Eigen::Vector2d& at) {
    const std::optional<Eigen::Vector3d> ray = camera_.ray(at);
    hits_.emplace_back();
    if (!ray) {
      rays_.push_back({{std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0}, 0.0});
      return;
    }
    Eigen::Matrix2d J = Eigen::Matrix2d::Identity();
    if (!camera_.distortion().none()) (void)camera_.distort(ray->head<2>(), &J);
    const PinholeCamera& pinhole = camera_.pinhole();
    rays_.push_back({*ray, 1.0 / (pinhole.fx_px * pinhole.fy_px * std::abs(J.determinant()))});
  }

  [[nodiscard]] Eigen::Vector2d pixel(int column, int row) const {
    return {(column + 0.5) * camera_.pinhole().width_px / kMeasureColumns - 0.5,
            (row + 0.5) * camera_.pinhole().height_px / kMeasureRows - 0.5};
  }

  /// Narrows the range of rays to those that may meet the triangle.
  void bound(const SeenTriangle& triangle, int& left, int& right, int& top, int& bottom) const {
    Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Array2d high = -low;
    for (const Eigen::Vector3d& p : triangle.points()) {
      const std::optional<Eigen::Vector2d> projected = view_.camera.project(p);
      if (!projected) return;
      low = low.min(projected->array());
      high = high.max(projected->array());
    }
    const double column_px = static_cast<double>(view_.camera.width_px) / kMeasureColumns;
    const double row_px = static_cast<double>(view_.camera.height_px) / kMeasureRows;
    const auto clamped = [](double value, int last) {
      return static_cast<int>(std::clamp(value, -1.0, last + 1.0));
    };
    left = std::max(left, clamped(std::ceil((low.x() + 0.5) / column_px - 0.5), kMeasureColumns));
    right =
        std::min(right, clamped(std::floor((high.x() + 0.5) / column_px - 0.5), kMeasureColumns));
    top = std::max(top, clamped(std::ceil((low.y() + 0.5) / row_px - 0.5), kMeasureRows));
    bottom = std::min(bottom, clamped(std::floor((high.y() + 0.5) / row_px - 0.5), kMeasureRows));
  }

  const View& view_;
  const CameraModel& camera_;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
};

/// The mesh's depth on the optical axis, refined on the ground itself.
std::optional<double> axis_depth(const GroundMesh& mesh,
                                 const View& view,
                                 const HeightQuery& ground) {
  Hit hit;
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const SeenTriangle triangle(mesh.vertices[mesh.indices[i]],
                                mesh.vertices[mesh.indices[i + 1]],
                                mesh.vertices[mesh.indices[i + 2]]);
    (void)triangle.intersect(axis, hit);
  }
  if (!std::isfinite(hit.depth_m)) return std::nullopt;
  const Eigen::Vector3d axis_world = view.R_camera_world.row(2).transpose();
  return refine_depth(ground, view.position_world, axis_world, hit.depth_m);
}

}  // namespace

ImageryQuery imagery_query(const terrain::TileSource& tiles) {
  return [&tiles](const terrain::TileId& tile, double u, double v) {
    const terrain::TileGrid& grid = tiles.grid();
    const double side_m = grid.tile_m(tile.level);
    const auto place_m = [&](int index, double texture) {
      const double texels = texture * terrain::kTileSide - terrain::kTileBorder;
      return (index + texels / terrain::kTileTexels) * side_m;
    };
    return tiles.has_imagery(grid.left_x_m + place_m(tile.col, u),
                             grid.top_y_m - place_m(tile.row, v));
  };
}

FrameStatistics statistics_of_rays(std::vector<double> texels_per_px,
                                   int void_rays,
                                   const terrain::TileSource& tiles) {
  FrameStatistics statistics;
  statistics.void_fraction = static_cast<double>(void_rays) / (kMeasureColumns * kMeasureRows);
  if (texels_per_px.empty()) return statistics;
  const double real_share = tiles.grid().texel_m / tiles.real_texel_m();
  const auto middle = texels_per_px.begin() + static_cast<std::ptrdiff_t>(texels_per_px.size() / 2);
  std::nth_element(texels_per_px.begin(), middle, texels_per_px.end());
  statistics.texels_per_pixel_median = real_share * *middle;
  statistics.texels_per_pixel_min =
      real_share * *std::min_element(texels_per_px.begin(), texels_per_px.end());
  return statistics;
}

FrameStatistics measure_frame(const GroundMesh& mesh,
                              const View& view,
                              const CameraModel& camera,
                              const terrain::TileSource& tiles,
                              const ImageryQuery& has_imagery) {
  SampleGrid grid(view, camera);
  for (const GroundBatch& batch : mesh.batches) {
    for (std::uint32_t i = batch.first_index; i < batch.first_index + batch.index_count; i += 3) {
      grid.add(SeenTriangle(mesh.vertices[mesh.indices[i]],
                            mesh.vertices[mesh.indices[i + 1]],
                            mesh.vertices[mesh.indices[i + 2]]),
               batch);
    }
  }
  std::vector<double> texels;
  int void_rays = 0;
  for (const Hit& hit : grid.hits()) {
    if (hit.batch == nullptr) continue;
    if (hit.batch->textured && has_imagery(hit.batch->texture, hit.u, hit.v)) {
      texels.push_back(hit.texels_per_px);
    } else {
      ++void_rays;
    }
  }
  FrameStatistics statistics = statistics_of_rays(std::move(texels), void_rays, tiles);
  statistics.axis_depth_m = axis_depth(mesh, view, tiles);
  return statistics;
}

}  // namespace overfly::renderer
