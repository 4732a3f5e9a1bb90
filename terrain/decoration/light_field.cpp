#include "terrain/decoration/light_field.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/motion/pose.hpp"

namespace overfly::terrain {
namespace {

constexpr double kSunRadiusRad = 0.2666 * kPi / 180.0;  // mean angular radius
constexpr double kFarthestM = 60e3;
/// Steps towards the sun grow with the distance, as the penumbra does (2 tan 0.2666 deg = 0.0093).
constexpr double kStepPerDistance = 0.02;
constexpr int kLog2Block = 6;  ///< nodes per side that share a chart

/// The direct light on a slope relative to flat ground.
double lambert(const LightOptions& options, const Eigen::Vector3d& sun, const Eigen::Vector3d& n) {
  const double ratio = std::max(0.0, n.dot(sun)) / sun.z();
  return 1.0 + options.hill_shading * (ratio - 1.0);
}

}  // namespace

double visible_disc(double above_rad) {
  const double x = std::clamp(above_rad / kSunRadiusRad, -1.0, 1.0);
  return 0.5 + (x * std::sqrt(1.0 - x * x) + std::asin(x)) / kPi;
}

double slope_light(const LightOptions& options, const Eigen::Vector3d& normal) {
  const double direct = lambert(options, sun_direction(options), normal);
  return std::min(kMaxLight, options.ambient + (1.0 - options.ambient) * direct);
}

LightField::LightField(std::shared_ptr<const TileSource> tiles,
                       const LightOptions& options,
                       double spacing_m)
    : tiles_(tiles),
      options_(options),
      sun_(sun_direction(options)),
      heights_(std::move(tiles), spacing_m),
      clouds_(options.clouds) {
  // Up coordinates decrease relative to heights with the distance from the origin, never increase.
  highest_up_m_ = tiles_->height_range_m().y() - tiles_->frame().origin().alt_ellipsoid_m;
}

LightField::Chart LightField::chart(int lattice, int block_i, int block_j) const {
  constexpr double kMiddle = 0.5 * (1 << kLog2Block);
  const Eigen::Vector2d map = heights_.map_of(
      lattice, (block_i << kLog2Block) + kMiddle, (block_j << kLog2Block) + kMiddle);
  constexpr double kStepM = 10.0;
  // Differences over flat steps of the map; the relief changes them by a part in 10^5.
  const auto world = [&](double dx, double dy) {
    return Eigen::Vector2d(tiles_->world_from_map(map.x() + dx, map.y() + dy).head<2>());
  };
  Chart chart;
  chart.world_per_map.col(0) = (world(kStepM, 0.0) - world(-kStepM, 0.0)) / (2.0 * kStepM);
  chart.world_per_map.col(1) = (world(0.0, kStepM) - world(0.0, -kStepM)) / (2.0 * kStepM);
  const double level = sun_.head<2>().norm();
  chart.sunward_map = Eigen::Vector2d::Zero();
  if (level > 1e-9) chart.sunward_map = chart.world_per_map.inverse() * sun_.head<2>() / level;
  return chart;
}

double LightField::horizon_rad(
    const Chart& chart, HeightLattice::Reader& heights, int lattice, int i, int j) const {
  const double up_m = heights.up_m(lattice, i, j);
  const double lowest_tan = std::tan(std::max(0.0, options_.sun_elevation_rad - kSunRadiusRad));
  double highest_tan = -1.0;
  double distance_m = heights_.spacing_m(lattice);
  while (distance_m < kFarthestM && up_m + distance_m * lowest_tan < highest_up_m_) {
    double step_m = std::max(heights_.spacing_m(lattice), kStepPerDistance * distance_m);
    int coarse = lattice;
    while (heights_.spacing_m(coarse + 1) <= step_m) ++coarse;
    const double nodes = distance_m / heights_.spacing_m(coarse);
    const double share = std::ldexp(1.0, lattice - coarse);
    const double ground_m = heights.up_m(coarse,
                                         i * share + nodes * chart.sunward_map.x(),
                                         j * share - nodes * chart.sunward_map.y());
    highest_tan = std::max(highest_tan, (ground_m - up_m) / distance_m);
    distance_m += step_m;
  }
  return std::atan(highest_tan);
}

double LightField::sunlight(
    const Chart& chart, HeightLattice::Reader& heights, int lattice, int i, int j) const {
  double direct = 1.0;
  if (options_.hill_shading > 0.0) {
    const double width_m = 2.0 * heights_.spacing_m(lattice);
    Eigen::Vector3d east;
    Eigen::Vector3d north;
    east << width_m * chart.world_per_map.col(0),
        heights.up_m(lattice, i + 1, j) - heights.up_m(lattice, i - 1, j);
    north << width_m * chart.world_per_map.col(1),
        heights.up_m(lattice, i, j - 1) - heights.up_m(lattice, i, j + 1);
    direct = lambert(options_, sun_, east.cross(north).normalized());
  }
  if (options_.cast_shadows > 0.0 && direct > 0.0) {
    const double above_rad =
        options_.sun_elevation_rad - horizon_rad(chart, heights, lattice, i, j);
    direct *= 1.0 - options_.cast_shadows * (1.0 - visible_disc(above_rad));
  }
  if (options_.clouds.cover > 0.0) {
    const Eigen::Vector2d map = heights_.map_of(lattice, i, j);
    const TileGrid& grid = tiles_->grid();
    direct *= clouds_.transmission(map.x() - grid.left_x_m, grid.top_y_m - map.y());
  }
  return std::min(kMaxLight, options_.ambient + (1.0 - options_.ambient) * direct);
}

ImageBuffer<float> LightField::nodes(int lattice, int i, int j, int columns, int rows) const {
  HeightLattice::Reader heights(heights_);
  ImageBuffer<float> light(columns, rows, 1);
  Chart here;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int at_i = i + column;
      const int at_j = j + row;
      constexpr int kInside = (1 << kLog2Block) - 1;
      if (column == 0 || (at_i & kInside) == 0) {
        here = chart(lattice, at_i >> kLog2Block, at_j >> kLog2Block);
      }
      light.at(column, row) = static_cast<float>(sunlight(here, heights, lattice, at_i, at_j));
    }
  }
  return light;
}

}  // namespace overfly::terrain
