#include "terrain/elevation_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace overfly::terrain {
namespace {

constexpr double kMaxPosts = 40e6;

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g %%", 100.0 * share);
  return text;
}

/// Share of the imagery's area over which some raster has posts.
double covered_share(const std::vector<ElevationRaster>& rasters, const MapRect& imagery) {
  constexpr int kSteps = 64;
  int covered = 0;
  for (int j = 0; j < kSteps; ++j) {
    for (int i = 0; i < kSteps; ++i) {
      const double x = imagery.x_min + (imagery.x_max - imagery.x_min) * (i + 0.5) / kSteps;
      const double y = imagery.y_min + (imagery.y_max - imagery.y_min) * (j + 0.5) / kSteps;
      covered += std::any_of(rasters.begin(), rasters.end(), [&](const ElevationRaster& raster) {
        return raster.covers(x, y);
      });
    }
  }
  return static_cast<double>(covered) / (kSteps * kSteps);
}

/// The part of an area where some raster has posts, to a hundredth of the area.
MapRect covered_part(const std::vector<ElevationRaster>& rasters, const MapRect& area) {
  constexpr int kSteps = 200;
  const double step_x = (area.x_max - area.x_min) / kSteps;
  const double step_y = (area.y_max - area.y_min) / kSteps;
  MapRect part{area.x_max, area.y_max, area.x_min, area.y_min};
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const double x = area.x_min + i * step_x;
      const double y = area.y_min + j * step_y;
      const bool covered =
          std::any_of(rasters.begin(), rasters.end(), [&](const ElevationRaster& raster) {
            return raster.covers(x, y);
          });
      if (!covered) continue;
      part = {std::min(part.x_min, x - step_x),
              std::min(part.y_min, y - step_y),
              std::max(part.x_max, x + step_x),
              std::max(part.y_max, y + step_y)};
    }
  }
  if (part.x_min > part.x_max) return area;
  return {std::max(part.x_min, area.x_min),
          std::max(part.y_min, area.y_min),
          std::min(part.x_max, area.x_max),
          std::min(part.y_max, area.y_max)};
}

}  // namespace

ElevationModel ElevationModel::flat(double height_m) {
  ElevationModel model;
  model.flat_height_m_ = height_m;
  model.range_m_ = {height_m, height_m};
  return model;
}

Result<ElevationModel> ElevationModel::load(const std::vector<ElevationLayer>& layers,
                                            const MapPlane& plane,
                                            const MapRect& imagery,
                                            const MapRect& area,
                                            std::vector<std::string>& warnings) {
  std::vector<ElevationRaster> rasters;
  for (const ElevationLayer& layer : layers) {
    auto raster = ElevationRaster::load(layer, plane, area, warnings);
    if (!raster) return raster.error();
    rasters.push_back(std::move(*raster));
  }
  const double share = covered_share(rasters, imagery);
  if (share == 0.0) {
    return Error{ErrorCode::kInvalidArgument,
                 rasters.front().file +
                     ": elevation does not overlap the imagery; check both georeferences"};
  }
  if (share < 0.999) {
    warnings.push_back(rasters.front().file + ": elevation covers " + percent(share) +
                       " of the imagery; the ground beyond goes on with the edge's height");
  }
  if (rasters.size() > 1) return merge(rasters, covered_part(rasters, area), warnings);
  ElevationModel model;
  model.post_from_map_ = std::move(rasters.front().post_from_map);
  model.spacing_m_ = rasters.front().spacing_m;
  const Status finished =
      model.finish(std::move(rasters.front().grid), rasters.front().file, warnings);
  if (!finished) return finished.error();
  return model;
}

Status ElevationModel::finish(HeightGrid grid,
                              const std::string& what,
                              std::vector<std::string>& warnings) {
  const std::size_t posts = grid.heights_m.size();
  const std::size_t filled = fill_voids(grid);
  if (filled == posts) {
    return Error{ErrorCode::kInvalidArgument, what + ": has no heights near the imagery"};
  }
  if (filled > 0) {
    warnings.push_back(what + ": " + std::to_string(filled) + " of " + std::to_string(posts) +
                       " posts (" + percent(static_cast<double>(filled) / posts) +
                       ") have no data and are filled from those around them");
  }
  const auto [low, high] = std::minmax_element(grid.heights_m.begin(), grid.heights_m.end());
  range_m_ = {*low, *high};
  grid_ = std::move(grid);
  return {};
}

/// Lays the rasters onto one grid parallel to the map's axes.
Result<ElevationModel> ElevationModel::merge(const std::vector<ElevationRaster>& rasters,
                                             const MapRect& area,
                                             std::vector<std::string>& warnings) {
  ElevationModel model;
  model.spacing_m_ = std::numeric_limits<double>::max();
  for (const ElevationRaster& raster : rasters) {
    model.spacing_m_ = std::min(model.spacing_m_, raster.spacing_m);
  }
  const double area_m2 = (area.x_max - area.x_min) * (area.y_max - area.y_min);
  const double limit_m = std::sqrt(area_m2 / kMaxPosts);
  if (model.spacing_m_ < limit_m) {
    warnings.push_back("elevation layers are merged at " + std::to_string(limit_m) +
                       " m between posts, coarser than the finest of them");
    model.spacing_m_ = limit_m;
  }
  HeightGrid grid;
  grid.columns = static_cast<int>((area.x_max - area.x_min) / model.spacing_m_) + 2;
  grid.rows = static_cast<int>((area.y_max - area.y_min) / model.spacing_m_) + 2;
  grid.heights_m.resize(static_cast<std::size_t>(grid.columns) * grid.rows);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      double height = std::numeric_limits<double>::quiet_NaN();
      for (const ElevationRaster& raster : rasters) {
        height = raster.height_m(area.x_min + column * model.spacing_m_,
                                 area.y_max - row * model.spacing_m_);
        if (!std::isnan(height)) break;
      }
      grid.at(column, row) = static_cast<float>(height);
    }
  }
  const double spacing_m = model.spacing_m_;
  const PlaneFunction posts = [&](const Eigen::Matrix2Xd& points, Eigen::MatrixXd& values) {
    values.resize(2, points.cols());
    values.row(0) = (points.row(0).array() - area.x_min) / spacing_m;
    values.row(1) = (area.y_max - points.row(1).array()) / spacing_m;
    return true;
  };
  model.post_from_map_ = SmoothMap<2>::fit(area, posts, 1e-6);
  if (!model.post_from_map_) return Error{ErrorCode::kInternal, "merged elevation grid: no fit"};
  const Status finished = model.finish(std::move(grid), "merged elevation", warnings);
  if (!finished) return finished.error();
  return model;
}

double ElevationModel::height_m(double x_map_m, double y_map_m) const {
  if (!post_from_map_) return flat_height_m_;
  const MapRect& known = post_from_map_->domain();
  const Eigen::Vector2d post = (*post_from_map_)(std::clamp(x_map_m, known.x_min, known.x_max),
                                                 std::clamp(y_map_m, known.y_min, known.y_max));
  return grid_.bilinear(post.x(), post.y());
}

}  // namespace overfly::terrain
