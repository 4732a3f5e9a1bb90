#include "renderer/raycast/block_builder.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderer/raycast/block_places.hpp"
#include "renderer/raycast/ground/posts_ahead.hpp"

namespace overfly::renderer::raycast {

namespace {

/// Seen from straight above, a change of height does not move the image, but it changes the depth
/// that flow and warping use. It is counted as this fraction of a change seen from the side.
constexpr double kLeastSide = 0.1;
constexpr int kFewPixels = 4;  ///< blocks this small are not divided: each pixel is cast
/// Ratio by which an error bound may exceed the limit while the block is still tested by a ray. A
/// depth image resolves the ground more finely, so it applies the bound directly.
constexpr double kLooseBound = 4.0;
/// Ratio of a block's sides above which only the longer one is halved.
constexpr double kMuchLonger = 1.5;

/// @param near  a node whose ground is near this ray's, or null
Node cast_node(const BlockSettings& settings,
               const RowPose& pose,
               const Eigen::Vector2d& ray,
               const Node* near) {
  Node node;
  node.ray = ray;
  if (!ray.allFinite()) return node;
  const Eigen::Vector3d direction = pose.R_world_camera.col(0) * ray.x() +
                                    pose.R_world_camera.col(1) * ray.y() +
                                    pose.R_world_camera.col(2);
  node.direction = direction;
  node.hit = settings.caster->cast(pose.position,
                                   direction,
                                   near != nullptr ? near->hit.depth : 0.0,
                                   near != nullptr ? near->hit.node : nullptr);
  if (node.hit.sky()) return node;
  node.inverse_depth = 1.0 / node.hit.depth;
  const Eigen::Vector2d texel = node.hit.texel();
  node.u = texel.x();
  node.v = texel.y();
  const double length = std::sqrt(1.0 + ray.squaredNorm());
  node.range_m = node.hit.depth * length;
  const double side =
      settings.depth_only ? 1.0 : std::max(direction.head<2>().norm() / length, kLeastSide);
  node.drop = std::abs(direction.z()) / length;
  node.px_per_m = settings.rays->px_per_rad() * side / node.range_m;
  return node;
}

/// A rectangle of pixels and the rays through its corners.
struct Patch {
  int x = 0, y = 0, columns = 0, rows = 0;  // pixels
  std::array<const Node*, 4> corners{};     // upper left, upper right, lower left, lower right
};

class BandBuilder {
 public:
  BandBuilder(const BlockSettings& settings, Band& band)
      : settings_(settings),
        band_(band),
        places_(*settings.tiles, band),
        air_per_m_(settings.request->atmosphere.extinction_per_m),
        reference_(settings.request->quality == RenderQuality::kReference && !settings.depth_only),
        lod_shift_(reference_ ? 1.0 : 0.0) {}

  void add(const Patch& patch) {
    const auto skies = std::count_if(
        patch.corners.begin(), patch.corners.end(), [](auto* node) { return node->hit.sky(); });
    if (skies == 4) return add_sky(patch);
    std::optional<Node> centre;
    if (skies == 0 && flat_enough(patch, centre)) return add_ground(patch);
    if (patch.columns * patch.rows <= kFewPixels) return add_pixels(patch);
    divide(patch, centre);
  }

 private:
  [[nodiscard]] double interpolation_error_px(const Patch& patch) const {
    double low_u = patch.corners[0]->u, high_u = low_u;
    double low_v = patch.corners[0]->v, high_v = low_v;
    for (const Node* node : patch.corners) {
      low_u = std::min(low_u, node->u);
      high_u = std::max(high_u, node->u);
      low_v = std::min(low_v, node->v);
      high_v = std::max(high_v, node->v);
    }
    const double size_m =
        std::max(high_u - low_u, high_v - low_v) * settings_.tiles->grid().texel_m;
    double worst_px = 0.0;
    for (const Node* node : patch.corners) {
      const double relief_m = relief_around(settings_.caster->tree(), node->hit, size_m);
      worst_px = std::max(worst_px, relief_m * node->px_per_m);
    }
    return worst_px;
  }

  /// True if the interpolation error is below kBlockErrorPx. The measured relief gives a bound,
  /// which is usually several times too large. If the bound exceeds the limit only moderately, the
  /// ray through the patch's centre decides, where a smooth surface deviates most. That ray also
  /// detects objects in front of the corners' ground.
  /// @param centre  is set to that ray if it is cast
  [[nodiscard]] bool flat_enough(const Patch& patch, std::optional<Node>& centre) const {
    const double bound_px = interpolation_error_px(patch);
    const double loose = settings_.depth_only ? 1.0 : kLooseBound;
    if (bound_px > loose * kBlockErrorPx) return false;
    const auto& c = patch.corners;
    const bool unoccluded = std::all_of(c.begin(), c.end(), [&](const Node* node) {
      return settings_.caster->meets_ground_once(node->direction);
    });
    if (bound_px <= kBlockErrorPx && unoccluded) return true;
    const Node& middle = centre.emplace(cast_in(patch, 0.5, 0.5));
    if (middle.hit.sky()) return false;
    const double expected = 0.25 * (c[0]->inverse_depth + c[1]->inverse_depth +
                                    c[2]->inverse_depth + c[3]->inverse_depth);
    // Deviation of the ground's height from the patch's surface, from their distance along the ray.
    const double off_m = std::abs(1.0 - middle.inverse_depth / expected) * middle.range_m;
    const double limit_px = bound_px <= kBlockErrorPx ? kBlockErrorPx : 0.5 * kBlockErrorPx;
    return off_m * middle.drop * middle.px_per_m <= limit_px;
  }

  /// The ray at a position of a patch, in [0, 1]^2.
  static Eigen::Vector2d ray_in(const Patch& patch, double a, double b) {
    const auto& c = patch.corners;
    return (1.0 - b) * ((1.0 - a) * c[0]->ray + a * c[1]->ray) +
           b * ((1.0 - a) * c[2]->ray + a * c[3]->ray);
  }

  static const Node* farthest_corner(const Patch& patch) {
    return *std::max_element(
        patch.corners.begin(), patch.corners.end(), [](const Node* a, const Node* b) {
          return a->hit.depth < b->hit.depth;
        });
  }

  [[nodiscard]] Node cast_in(const Patch& patch, double a, double b) const {
    const double row = patch.y - 0.5 + b * patch.rows;
    return cast_node(
        settings_, settings_.poses->at(row), ray_in(patch, a, b), farthest_corner(patch));
  }

  /// Distance on the ground between two rays' hits; large if one of them hits the sky.
  static double apart(const Node& a, const Node& b) {
    if (a.hit.sky() || b.hit.sky()) return a.hit.sky() == b.hit.sky() ? 0.0 : 1e9;
    return Eigen::Vector2d(a.u - b.u, a.v - b.v).norm();
  }

  /// Halves the side that is longer on the ground, or both.
  /// @param centre  the ray through the patch's centre, if it was cast
  void divide(const Patch& patch, const std::optional<Node>& centre) {
    const auto& c = patch.corners;
    const double wide = std::max(apart(*c[0], *c[1]), apart(*c[2], *c[3]));
    const double high = std::max(apart(*c[0], *c[2]), apart(*c[1], *c[3]));
    if (patch.rows == 1 || (patch.columns > 1 && wide > kMuchLonger * high)) {
      divide_columns(patch);
    } else if (patch.columns == 1 || high > kMuchLonger * wide) {
      divide_rows(patch);
    } else {
      divide_both(patch, centre);
    }
  }

  void divide_columns(const Patch& patch) {
    const int left = (patch.columns + 1) / 2;
    const double a = static_cast<double>(left) / patch.columns;
    const Node top = cast_in(patch, a, 0.0), bottom = cast_in(patch, a, 1.0);
    const auto& c = patch.corners;
    add({patch.x, patch.y, left, patch.rows, {c[0], &top, c[2], &bottom}});
    add({patch.x + left, patch.y, patch.columns - left, patch.rows, {&top, c[1], &bottom, c[3]}});
  }

  void divide_rows(const Patch& patch) {
    const int upper = (patch.rows + 1) / 2;
    const double b = static_cast<double>(upper) / patch.rows;
    const Node west = cast_in(patch, 0.0, b), east = cast_in(patch, 1.0, b);
    const auto& c = patch.corners;
    add({patch.x, patch.y, patch.columns, upper, {c[0], c[1], &west, &east}});
    add({patch.x, patch.y + upper, patch.columns, patch.rows - upper, {&west, &east, c[2], c[3]}});
  }

  void divide_both(const Patch& patch, const std::optional<Node>& centre) {
    const int left = (patch.columns + 1) / 2;
    const int upper = (patch.rows + 1) / 2;
    const double a = static_cast<double>(left) / patch.columns;
    const double b = static_cast<double>(upper) / patch.rows;
    const Node top = cast_in(patch, a, 0.0), bottom = cast_in(patch, a, 1.0);
    const Node west = cast_in(patch, 0.0, b), east = cast_in(patch, 1.0, b);
    const bool at_centre = centre && a == 0.5 && b == 0.5;
    const Node middle = at_centre ? *centre : cast_in(patch, a, b);
    const auto& c = patch.corners;
    const int right = patch.columns - left, lower = patch.rows - upper;
    add({patch.x, patch.y, left, upper, {c[0], &top, &west, &middle}});
    add({patch.x + left, patch.y, right, upper, {&top, c[1], &middle, &east}});
    add({patch.x, patch.y + upper, left, lower, {&west, &middle, c[2], &bottom}});
    add({patch.x + left, patch.y + upper, right, lower, {&middle, &east, &bottom, c[3]}});
  }

  Block block_of(const Patch& patch) const {
    Block block;
    block.x = static_cast<std::uint16_t>(patch.x);
    block.y = static_cast<std::uint16_t>(patch.y);
    block.columns = static_cast<std::uint8_t>(patch.columns);
    block.rows = static_cast<std::uint8_t>(patch.rows);
    return block;
  }

  void add_sky(const Patch& patch) { band_.blocks.push_back(block_of(patch)); }

  /// The bilinear function with these values at the patch's corners.
  static Bilinear4 bilinear(const Patch& patch, const std::array<double, 4>& f) {
    const double columns = patch.columns, rows = patch.rows;
    const double c1 = (f[1] - f[0]) / columns;
    const double c2 = (f[2] - f[0]) / rows;
    const double c3 = (f[3] - f[2] - f[1] + f[0]) / (columns * rows);
    // The corners lie half a pixel before the first pixel.
    return {static_cast<float>(f[0] + 0.5 * (c1 + c2) + 0.25 * c3),
            static_cast<float>(c1 + 0.5 * c3),
            static_cast<float>(c2 + 0.5 * c3),
            static_cast<float>(c3)};
  }

  void add_ground(const Patch& patch) {
    Block block = block_of(patch);
    block.kind = Block::Kind::kGround;
    const auto& c = patch.corners;
    block.u = 0.25 * (c[0]->u + c[1]->u + c[2]->u + c[3]->u);
    block.v = 0.25 * (c[0]->v + c[1]->v + c[2]->v + c[3]->v);
    std::array<double, 4> u{}, v{}, w{}, lod{}, clear{};
    for (int i = 0; i < 4; ++i) {
      w[i] = c[i]->inverse_depth;
      u[i] = (c[i]->u - block.u) * w[i];
      v[i] = (c[i]->v - block.v) * w[i];
      clear[i] = transmission(*c[i]);
    }
    for (int i = 0; i < 4; ++i) {
      const int along_x = i | 1, along_y = i | 2;
      const double du = u[i] / w[i], dv = v[i] / w[i];
      const auto rate = [&](const std::array<double, 4>& f, double value, int to, int from, int n) {
        return (f[to] - f[from] - value * (w[to] - w[from])) / (n * w[i]);
      };
      const double u_x = rate(u, du, along_x, along_x ^ 1, patch.columns);
      const double v_x = rate(v, dv, along_x, along_x ^ 1, patch.columns);
      const double u_y = rate(u, du, along_y, along_y ^ 2, patch.rows);
      const double v_y = rate(v, dv, along_y, along_y ^ 2, patch.rows);
      lod[i] = texel_lod(u_x, v_x, u_y, v_y) - lod_shift_;
    }
    block.numerator_u = bilinear(patch, u);
    block.numerator_v = bilinear(patch, v);
    block.inverse_depth = bilinear(patch, w);
    block.lod = bilinear(patch, lod);
    block.clear = bilinear(patch, clear);
    keep(block);
  }

  [[nodiscard]] double transmission(const Node& node) const {
    return air_per_m_ > 0.0 ? std::exp(-air_per_m_ * node.range_m) : 1.0;
  }

  void add_pixels(const Patch& patch) {
    for (int y = 0; y < patch.rows; ++y) {
      for (int x = 0; x < patch.columns; ++x) {
        if (!reference_) {
          add_pixel(patch, x, y, 0.0, 0.0, false);
          continue;
        }
        for (const double dy : {-0.25, 0.25}) {
          for (const double dx : {-0.25, 0.25}) add_pixel(patch, x, y, dx, dy, true);
        }
      }
    }
  }

  /// One pixel (or a quarter of one) with its own ray and the ground's tangent plane there.
  void add_pixel(const Patch& patch, int x, int y, double dx, double dy, bool quarter) {
    Block block = block_of({patch.x + x, patch.y + y, 1, 1, {}});
    block.quarter = quarter;
    const double a = (x + 0.5 + dx) / patch.columns;
    const double b = (y + 0.5 + dy) / patch.rows;
    const Eigen::Vector2d ray = ray_in(patch, a, b);
    const RowPose& pose = settings_.poses->at(patch.y + y);
    const Node node = cast_node(settings_, pose, ray, farthest_corner(patch));
    if (node.hit.sky()) {
      band_.blocks.push_back(block);
      return;
    }
    block.kind = Block::Kind::kGround;
    block.u = node.u;
    block.v = node.v;
    block.inverse_depth = {static_cast<float>(node.inverse_depth), 0.0F, 0.0F, 0.0F};
    block.clear = {static_cast<float>(transmission(node)), 0.0F, 0.0F, 0.0F};
    const Eigen::Vector2d step_x = (ray_in(patch, 1.0, b) - ray_in(patch, 0.0, b)) / patch.columns;
    const Eigen::Vector2d step_y = (ray_in(patch, a, 1.0) - ray_in(patch, a, 0.0)) / patch.rows;
    const Eigen::Matrix2d J = texel_jacobian(node.hit, pose, ray, step_x, step_y);
    block.lod[0] = static_cast<float>(texel_lod(J(0, 0), J(1, 0), J(0, 1), J(1, 1)) - lod_shift_);
    keep(block);
  }

  void keep(const Block& block) {
    if (settings_.depth_only) {
      band_.blocks.push_back(block);
    } else {
      places_.add(block);
    }
  }

  const BlockSettings& settings_;
  Band& band_;
  BlockPlaces places_;
  double air_per_m_;
  bool reference_;
  double lod_shift_;  // for samples at half the distance, texels of half the size
};

}  // namespace

Eigen::Matrix2d texel_jacobian(const GroundHit& hit,
                               const RowPose& pose,
                               const Eigen::Vector2d& ray,
                               const Eigen::Vector2d& step_x,
                               const Eigen::Vector2d& step_y) {
  const Eigen::Matrix3d& R = pose.R_world_camera;
  const Eigen::Vector3d direction = R * Eigen::Vector3d(ray.x(), ray.y(), 1.0);
  const Eigen::Vector2d slope = hit.slope();
  const Eigen::Vector3d normal(-slope.x(), -slope.y(), 1.0);
  const double facing = normal.dot(direction);
  Eigen::Matrix2d steps_m;  // d(east, north) / d(x, y)
  int column = 0;
  for (const Eigen::Vector2d& step : {step_x, step_y}) {
    const Eigen::Vector3d turn = R.leftCols<2>() * step;
    // The point stays on the tangent plane: depth (turn - direction (n turn) / (n direction)).
    const double along = std::abs(facing) > 1e-9 ? normal.dot(turn) / facing : 0.0;
    steps_m.col(column++) = hit.depth * (turn - along * direction).head<2>();
  }
  return hit.texels_per_m() * steps_m;
}

void cast_row(const BlockSettings& settings, int row, std::vector<Node>& nodes) {
  const RayGrid& rays = *settings.rays;
  const RowPose& pose = settings.poses->at(rays.top_px(row) - 0.5);
  nodes.clear();
  nodes.reserve(static_cast<std::size_t>(rays.columns()) + 1);
  for (int column = 0; column <= rays.columns(); ++column) {
    const Node* left = nodes.empty() ? nullptr : &nodes.back();
    nodes.push_back(cast_node(settings, pose, rays.ray(column, row), left));
  }
}

void build_band(const BlockSettings& settings,
                int row,
                const std::vector<Node>& upper,
                const std::vector<Node>& lower,
                Band& band) {
  band.blocks.clear();
  band.tiles.clear();
  BandBuilder builder(settings, band);
  const RayGrid& rays = *settings.rays;
  const int y = rays.top_px(row);
  const int rows = rays.top_px(row + 1) - y;
  for (int column = 0; column < rays.columns(); ++column) {
    if (const int next = column + 1; next < rays.columns()) {
      request_between(
          {&upper[next].hit, &upper[next + 1].hit, &lower[next].hit, &lower[next + 1].hit});
    }
    const int x = rays.left_px(column);
    const int columns = rays.left_px(column + 1) - x;
    builder.add({x,
                 y,
                 columns,
                 rows,
                 {&upper[column], &upper[column + 1], &lower[column], &lower[column + 1]}});
  }
}

}  // namespace overfly::renderer::raycast
