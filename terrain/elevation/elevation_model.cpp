#include "terrain/elevation/elevation_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/text/percent.hpp"
#include "terrain/height_errors.hpp"

namespace overfly::terrain {
namespace {

using RasterPtr = std::shared_ptr<ElevationRaster>;
using Rasters = std::vector<RasterPtr>;

/// Maximum memory for blocks of heights.
constexpr std::size_t kCacheBytes = std::size_t{128} << 20U;
/// Maximum number of posts of a merged grid.
constexpr double kMaxMergedPosts = 200e6;

/// Fraction of the imagery's area that is covered by posts of some raster.
double covered_share(const Rasters& rasters, const MapRect& imagery) {
  constexpr int kSteps = 64;
  int covered = 0;
  for (int j = 0; j < kSteps; ++j) {
    for (int i = 0; i < kSteps; ++i) {
      const double x = imagery.x_min + (imagery.x_max - imagery.x_min) * (i + 0.5) / kSteps;
      const double y = imagery.y_min + (imagery.y_max - imagery.y_min) * (j + 0.5) / kSteps;
      covered += std::any_of(rasters.begin(), rasters.end(), [&](const RasterPtr& raster) {
        return raster->covers(x, y);
      });
    }
  }
  if (covered > 0) return static_cast<double>(covered) / (kSteps * kSteps);
  double share = 0.0;  // of a raster between the places
  for (const RasterPtr& raster : rasters) share = std::max(share, raster->overlap_share(imagery));
  return share;
}

/// The part of an area that is covered by posts of some raster, to a hundredth of the area.
MapRect covered_part(const Rasters& rasters, const MapRect& area) {
  constexpr int kSteps = 200;
  const double step_x = (area.x_max - area.x_min) / kSteps;
  const double step_y = (area.y_max - area.y_min) / kSteps;
  MapRect part{area.x_max, area.y_max, area.x_min, area.y_min};
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const double x = area.x_min + i * step_x;
      const double y = area.y_min + j * step_y;
      const bool covered =
          std::any_of(rasters.begin(), rasters.end(), [&](const RasterPtr& raster) {
            return raster->covers(x, y);
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

/// Reads the posts of a merged grid from the first raster that has data.
PostReader merged_reader(Rasters rasters, const MapRect& area, double spacing_m) {
  return [rasters = std::move(rasters), area, spacing_m](
             int column, int row, int columns, int rows) -> Result<RawPosts> {
    const HeightErrors errors;
    RawPosts posts;
    posts.grid.columns = columns;
    posts.grid.rows = rows;
    posts.grid.heights_m.resize(static_cast<std::size_t>(columns) * rows);
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        double height = std::numeric_limits<double>::quiet_NaN();
        for (const RasterPtr& raster : rasters) {
          height = raster->height_m(area.x_min + (column + i) * spacing_m,
                                    area.y_max - (row + j) * spacing_m);
          if (!std::isnan(height)) break;
        }
        posts.grid.at(i, j) = static_cast<float>(height);
        posts.outside += std::isnan(height) &&
                         std::none_of(rasters.begin(), rasters.end(), [&](const RasterPtr& raster) {
                           return raster->covers(area.x_min + (column + i) * spacing_m,
                                                 area.y_max - (row + j) * spacing_m);
                         });
      }
    }
    if (Status read = errors.status(); !read) return read.error();
    return posts;
  };
}

/// Moves an area's north-west corner inwards to a post of a raster that is parallel to the map and
/// has square meshes, so that posts at the returned spacing [m] are those of the raster. Empty for
/// other rasters.
std::optional<double> align(const ElevationRaster& raster, MapRect& area) {
  const SmoothMap<2>& post_from_map = raster.post_from_map();
  const Eigen::Vector2d first = post_from_map(area.x_min, area.y_max);
  const Eigen::Vector2d last = post_from_map(area.x_max, area.y_min);
  const double spacing_m = (area.x_max - area.x_min) / (last.x() - first.x());
  if (!(spacing_m > 0.0)) return std::nullopt;
  for (const double x : {area.x_min, 0.5 * (area.x_min + area.x_max), area.x_max}) {
    for (const double y : {area.y_min, 0.5 * (area.y_min + area.y_max), area.y_max}) {
      const Eigen::Vector2d parallel =
          first + Eigen::Vector2d(x - area.x_min, area.y_max - y) / spacing_m;
      constexpr double kTolerancePosts = 1e-3;
      if (!((post_from_map(x, y) - parallel).norm() < kTolerancePosts)) return std::nullopt;
    }
  }
  area.x_min += (std::ceil(first.x()) - first.x()) * spacing_m;
  area.y_max -= (std::ceil(first.y()) - first.y()) * spacing_m;
  return spacing_m;
}

}  // namespace

ElevationModel ElevationModel::flat(double height_m) {
  ElevationModel model;
  model.flat_height_m_ = height_m;
  model.range_m_ = {height_m, height_m};
  return model;
}

Result<ElevationModel> ElevationModel::open(const std::vector<ElevationLayer>& layers,
                                            const MapPlane& plane,
                                            const MapRect& imagery,
                                            const MapRect& area,
                                            double max_posts,
                                            std::vector<std::string>& warnings) {
  ElevationModel model;
  model.area_ = area;
  const std::vector<int> all_posts(layers.size(), 1);
  if (Status opened = model.open_layers(layers, plane, area, all_posts, warnings); !opened) {
    return opened.error();
  }
  const RasterPtr& first = model.parts_->rasters.front();
  const double share = covered_share(model.parts_->rasters, imagery);
  if (share == 0.0) {
    return Error{ErrorCode::kInvalidArgument,
                 first->file() +
                     ": elevation does not overlap the imagery; check both georeferences" +
                     first->whereabouts()};
  }
  if (share < 0.999) {
    warnings.push_back(first->file() + ": elevation covers " + percent_text(share) +
                       " of the imagery; beyond, the ground continues with the edge's height");
  }
  if (Status laid = model.lay_grid(area, 0.0, max_posts, warnings); !laid) return laid.error();
  return model;
}

Status ElevationModel::open_layers(const std::vector<ElevationLayer>& layers,
                                   const MapPlane& plane,
                                   const MapRect& area,
                                   const std::vector<int>& steps,
                                   std::vector<std::string>& warnings) {
  parts_ = std::make_shared<Parts>();
  parts_->cache = std::make_shared<BlockCache>(kCacheBytes);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    auto raster = ElevationRaster::open(layers[i], plane, area, parts_->cache, steps[i], warnings);
    if (!raster) return raster.error();
    parts_->rasters.push_back(std::move(*raster));
  }
  return {};
}

/// Lays the grid of posts: that of the only layer, or one onto which all are merged.
Status ElevationModel::lay_grid(const MapRect& area,
                                double least_spacing_m,
                                double max_posts,
                                std::vector<std::string>& warnings) {
  Parts& parts = *parts_;
  if (parts.rasters.size() > 1) {
    return merge(covered_part(parts.rasters, area), least_spacing_m, max_posts, warnings);
  }
  const RasterPtr& first = parts.rasters.front();
  const double posts = static_cast<double>(first->columns()) * first->rows();
  if (posts > max_posts) {
    return Error{ErrorCode::kUnsupported,
                 first->file() + ": " + std::to_string(first->columns()) + " x " +
                     std::to_string(first->rows()) + " posts around the imagery, limit " +
                     std::to_string(static_cast<long long>(max_posts))};
  }
  what_ = first->file();
  post_from_map_ = first->post_from_map();
  spacing_m_ = first->spacing_m();
  parts.pyramid =
      std::make_unique<HeightPyramid>(first->columns(),
                                      first->rows(),
                                      parts.cache,
                                      [first](int column, int row, int columns, int rows) {
                                        return first->read(column, row, columns, rows);
                                      });
  parts.heights = &parts.pyramid->filled();
  return {};
}

/// Resamples the rasters to one grid parallel to the map's axes.
Status ElevationModel::merge(const MapRect& covered,
                             double least_spacing_m,
                             double max_posts,
                             std::vector<std::string>& warnings) {
  const RasterPtr& finest = *std::min_element(
      parts_->rasters.begin(), parts_->rasters.end(), [](const RasterPtr& a, const RasterPtr& b) {
        return a->spacing_m() < b->spacing_m();
      });
  MapRect area = covered;
  spacing_m_ = align(*finest, area).value_or(finest->spacing_m());
  spacing_m_ = std::max(spacing_m_, least_spacing_m);
  const double area_m2 = (area.x_max - area.x_min) * (area.y_max - area.y_min);
  if (area_m2 / (spacing_m_ * spacing_m_) > max_posts) {
    return Error{ErrorCode::kUnsupported, "merged elevation: too many posts around the imagery"};
  }
  const double limit_m = std::sqrt(area_m2 / kMaxMergedPosts);
  if (spacing_m_ < limit_m) {
    warnings.push_back("elevation layers are merged at " + std::to_string(limit_m) +
                       " m between posts, coarser than the finest of them");
    spacing_m_ = limit_m;
  }
  const double spacing_m = spacing_m_;
  const PlaneFunction posts = [&](const Eigen::Matrix2Xd& points, Eigen::MatrixXd& values) {
    values.resize(2, points.cols());
    values.row(0) = (points.row(0).array() - area.x_min) / spacing_m;
    values.row(1) = (area.y_max - points.row(1).array()) / spacing_m;
    return true;
  };
  post_from_map_ = SmoothMap<2>::fit(area, posts, 1e-6);
  if (!post_from_map_) return Error{ErrorCode::kInternal, "merged elevation grid: no fit"};
  what_ = "merged elevation";
  parts_->pyramid =
      std::make_unique<HeightPyramid>(static_cast<int>((area.x_max - area.x_min) / spacing_m) + 2,
                                      static_cast<int>((area.y_max - area.y_min) / spacing_m) + 2,
                                      parts_->cache,
                                      merged_reader(parts_->rasters, area, spacing_m));
  parts_->heights = &parts_->pyramid->filled();
  return {};
}

Status ElevationModel::use(std::shared_ptr<const HeightStore> store,
                           HeightReach reach,
                           std::vector<std::string>& warnings) {
  const PagedHeights& shape = parts_->pyramid->filled();
  parts_->store = std::move(store);
  parts_->stored = std::make_unique<PagedHeights>(
      shape.columns(0),
      shape.rows(0),
      parts_->cache,
      [kept = parts_->store.get(), reach](int level, int column, int row) {
        return kept->block(reach, level, column, row);
      });
  parts_->heights = parts_->stored.get();
  return take(*parts_->store->survey(reach), warnings);
}

double ElevationModel::at_level(int level, double x_map_m, double y_map_m) const {
  const MapRect& known = post_from_map_->domain();
  const Eigen::Vector2d post = (*post_from_map_)(std::clamp(x_map_m, known.x_min, known.x_max),
                                                 std::clamp(y_map_m, known.y_min, known.y_max));
  double height = 0.0;
  if (level == 0) {
    height = parts_->heights->bilinear(0, post.x(), post.y());
  } else {
    // The centre of a level's post (i, j) is the centre of the posts that it averages.
    const double scale = std::ldexp(1.0, -level);
    height = parts_->heights->bilinear(
        level, (post.x() + 0.5) * scale - 0.5, (post.y() + 0.5) * scale - 0.5);
  }
  return std::isnan(height) ? range_m_.x() : height;
}

double ElevationModel::height_m(double x_map_m, double y_map_m) const {
  return coarse_height_m(x_map_m, y_map_m, 0.0);
}

double ElevationModel::coarse_height_m(double x_map_m, double y_map_m, double spacing_m) const {
  if (!parts_) return flat_height_m_;
  const double share = near_share(x_map_m, y_map_m);
  if (share == 0.0) return far_->coarse_height_m(x_map_m, y_map_m, spacing_m);
  int level = 0;
  while (level + 1 < parts_->heights->levels() && spacing_m_ * (2 << level) <= spacing_m) ++level;
  const double near_m = at_level(level, x_map_m, y_map_m);
  if (share == 1.0) return near_m;
  const double far_m = far_->coarse_height_m(x_map_m, y_map_m, spacing_m);
  return far_m + share * (near_m - far_m);
}

Status ElevationModel::status() const {
  if (!parts_) return {};
  if (auto error = parts_->heights->read_error()) return *error;
  return far_ ? far_->status() : Status{};
}

std::vector<std::string> ElevationModel::relations() const {
  std::vector<std::string> all;
  if (!parts_) return all;
  for (const RasterPtr& raster : parts_->rasters) all.push_back(raster->relation());
  return all;
}

std::vector<HeightDatum> ElevationModel::datums() const {
  std::vector<HeightDatum> all;
  if (!parts_) return all;
  for (const RasterPtr& raster : parts_->rasters) all.push_back(raster->datum());
  return all;
}

std::string ElevationModel::fingerprint() const {
  if (!parts_) return "flat";
  const PagedHeights& shape = parts_->pyramid->filled();
  const MapRect& known = post_from_map_->domain();
  const Eigen::Vector2d corner = (*post_from_map_)(known.x_min, known.y_min);
  char text[256];
  std::snprintf(text,
                sizeof(text),
                "%d x %d posts every %.17g m, corner %.17g %.17g of %.17g %.17g",
                shape.columns(0),
                shape.rows(0),
                spacing_m_,
                corner.x(),
                corner.y(),
                known.x_min,
                known.y_min);
  std::string result = text;
  for (const RasterPtr& raster : parts_->rasters) {
    result += "; posts " + raster->post_from_map().fingerprint() + ", " + raster->relation();
  }
  if (far_) result += "; beyond " + far_->fingerprint();
  return result;
}

}  // namespace overfly::terrain
