#include "terrain/elevation_raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/pose.hpp"
#include "terrain/datum_shift.hpp"
#include "terrain/geoid.hpp"
#include "terrain/raster_bands.hpp"

namespace overfly::terrain {
namespace {

/// Posts kept of one file at most (160 MB).
constexpr double kMaxPosts = 40e6;
constexpr double kFootM = 0.3048;
constexpr double kUsSurveyFootM = 1200.0 / 3937.0;

struct PostWindow {
  int column = 0;
  int row = 0;
  int columns = 0;
  int rows = 0;
};

PlaneFunction posts_of(const MapPlane& plane,
                       const CrsTransform& crs_from_wgs84,
                       const GeoTransform& transform) {
  return [&plane, &crs_from_wgs84, transform](const Eigen::Matrix2Xd& points,
                                              Eigen::MatrixXd& values) {
    Eigen::Matrix2Xd crs_points = points;
    if (!plane.to_crs(crs_from_wgs84, crs_points)) return false;
    values.resize(2, points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      transform.pixel_from_crs(crs_points(0, i), crs_points(1, i), values(0, i), values(1, i));
    }
    values.array() -= 0.5;  // posts are pixel centres
    return true;
  };
}

/// The file's posts that the area needs, one beyond its edge.
PostWindow window_over(const SmoothMap<2>& post_from_map, int width, int height) {
  const MapRect& area = post_from_map.domain();
  Eigen::Vector2d low(1e18, 1e18);
  Eigen::Vector2d high(-1e18, -1e18);
  constexpr int kSteps = 32;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const Eigen::Vector2d post =
          post_from_map(area.x_min + (area.x_max - area.x_min) * i / kSteps,
                        area.y_min + (area.y_max - area.y_min) * j / kSteps);
      low = low.cwiseMin(post);
      high = high.cwiseMax(post);
    }
  }
  constexpr double kMargin = 4.0;
  const auto clamped = [](double value, int size) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(size)));
  };
  PostWindow window;
  window.column = clamped(std::floor(low.x() - kMargin), width);
  window.row = clamped(std::floor(low.y() - kMargin), height);
  window.columns = clamped(std::ceil(high.x() + kMargin), width) - window.column;
  window.rows = clamped(std::ceil(high.y() + kMargin), height) - window.row;
  return window;
}

/// Metres per unit of the heights: said by the caller, the band, or the vertical CRS.
double unit_of(GDALDataset& dataset,
               const ElevationLayer& layer,
               const OGRSpatialReference& crs,
               std::vector<std::string>& warnings) {
  if (layer.unit_m) return *layer.unit_m;
  std::string unit = dataset.GetRasterBand(1)->GetUnitType();
  std::transform(unit.begin(), unit.end(), unit.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  if (unit == "m" || unit == "metre" || unit == "meter" || unit == "metres" || unit == "meters") {
    return 1.0;
  }
  if (unit.find("us") != std::string::npos && unit.find('f') != std::string::npos) {
    return kUsSurveyFootM;
  }
  if (unit == "ft" || unit == "foot" || unit == "feet") return kFootM;
  if (crs.IsVertical() != 0) return crs.GetTargetLinearUnits("VERT_CS");
  const bool feet = crs.IsProjected() != 0 && std::abs(crs.GetLinearUnits() - 1.0) > 1e-3;
  if (!unit.empty() || feet) {
    warnings.push_back(layer.file.string() + ": unit of the heights is " +
                       (unit.empty() ? "not said" : "\"" + unit + "\"") +
                       "; taken as metres. If they are feet, the ground is 3.28 times too high: "
                       "say \"unit_m\" in the manifest");
  }
  return 1.0;
}

VerticalDatum datum_of(const ElevationLayer& layer, const OGRSpatialReference& crs) {
  if (layer.datum != VerticalDatum::kUnknown) return layer.datum;
  if (crs.IsVertical() == 0) return VerticalDatum::kUnknown;
  const char* name = crs.GetAttrValue("VERT_CS");
  const std::string text = name != nullptr ? name : "";
  if (text.find("NAVD88") != std::string::npos) return VerticalDatum::kNavd88;
  if (text.find("EGM2008") != std::string::npos) return VerticalDatum::kEgm2008;
  if (text.find("EGM96") != std::string::npos) return VerticalDatum::kEgm96;
  return VerticalDatum::kUnknown;
}

/// Marks posts without data as NaN and scales the others to metres.
/// @return posts whose value no ground on earth has, without being declared as nodata
std::size_t to_metres(GDALRasterBand& band, double unit_m, HeightGrid& grid) {
  int has_nodata = 0;
  const double nodata = band.GetNoDataValue(&has_nodata);
  const double scale = band.GetScale() * unit_m;
  const double offset = band.GetOffset() * unit_m;
  constexpr double kLowestM = -12000.0;
  constexpr double kHighestM = 9000.0;
  std::size_t implausible = 0;
  for (float& height : grid.heights_m) {
    const bool declared = has_nodata != 0 && height == static_cast<float>(nodata);
    const double metres = height * scale + offset;
    if (!declared && metres >= kLowestM && metres <= kHighestM) {
      height = static_cast<float>(metres);
      continue;
    }
    if (!declared && !std::isnan(height)) ++implausible;
    height = std::numeric_limits<float>::quiet_NaN();
  }
  return implausible;
}

/// Adds the geoid's separation, interpolated between the nodes of a lattice over the posts.
Status add_separation(const GeoidModel& model,
                      const GeoTransform& transform,
                      const CrsTransform& wgs84_from_crs,
                      const PostWindow& window,
                      HeightGrid& grid) {
  constexpr int kNodes = 65;
  Eigen::Matrix2Xd points(2, kNodes * kNodes);
  for (int j = 0; j < kNodes; ++j) {
    for (int i = 0; i < kNodes; ++i) {
      const double px = window.column + 0.5 + (window.columns - 1.0) * i / (kNodes - 1);
      const double py = window.row + 0.5 + (window.rows - 1.0) * j / (kNodes - 1);
      transform.crs_from_pixel(px, py, points(0, j * kNodes + i), points(1, j * kNodes + i));
    }
  }
  if (!wgs84_from_crs.apply(points)) {
    return Error{ErrorCode::kInvalidArgument, "posts have no place in WGS84"};
  }
  const Eigen::VectorXd separation = geoid_separation_m(model, points * rad_from_deg(1.0));
  HeightGrid lattice;
  lattice.columns = kNodes;
  lattice.rows = kNodes;
  lattice.heights_m.assign(separation.data(), separation.data() + separation.size());
  const double step_u = (kNodes - 1.0) / std::max(1, grid.columns - 1);
  const double step_v = (kNodes - 1.0) / std::max(1, grid.rows - 1);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      grid.at(column, row) += static_cast<float>(lattice.bilinear(column * step_u, row * step_v));
    }
  }
  return {};
}

Result<HeightGrid> read_posts(GDALDataset& dataset,
                              const PostWindow& window,
                              const std::string& file) {
  HeightGrid grid;
  grid.columns = window.columns;
  grid.rows = window.rows;
  grid.heights_m.resize(static_cast<std::size_t>(window.columns) * window.rows);
  const GdalMessages messages;
  if (dataset.GetRasterBand(1)->RasterIO(GF_Read,
                                         window.column,
                                         window.row,
                                         window.columns,
                                         window.rows,
                                         grid.heights_m.data(),
                                         window.columns,
                                         window.rows,
                                         GDT_Float32,
                                         0,
                                         0,
                                         nullptr) != CE_None) {
    return Error{ErrorCode::kUnreadable, file + ": heights cannot be read: " + messages.text()};
  }
  return grid;
}

/// Turns raw values into metres above the ellipsoid; doubts go to `warnings`.
Status to_ellipsoidal_metres(GDALDataset& dataset,
                             const ElevationLayer& layer,
                             const Georeference& place,
                             const PostWindow& window,
                             HeightGrid& grid,
                             std::vector<std::string>& warnings) {
  const std::string file = layer.file.string();
  const double unit_m = unit_of(dataset, layer, place.crs, warnings);
  const std::size_t implausible = to_metres(*dataset.GetRasterBand(1), unit_m, grid);
  if (implausible > 0) {
    warnings.push_back(file + ": " + std::to_string(implausible) +
                       " heights outside -12000 to 9000 m are taken as missing");
  }
  auto wgs84_from_crs = CrsTransform::create(place.crs, wgs84_crs(), file);
  if (!wgs84_from_crs) return wgs84_from_crs.error();
  Eigen::Matrix2Xd middle(2, 1);
  place.transform.crs_from_pixel(window.column + 0.5 * window.columns,
                                 window.row + 0.5 * window.rows,
                                 middle(0, 0),
                                 middle(1, 0));
  if (auto doubt = datum_shift_doubt(place.crs, middle(0, 0), middle(1, 0), file)) {
    warnings.push_back(std::move(*doubt));
  }
  if (!(*wgs84_from_crs)->apply(middle)) {
    return Error{ErrorCode::kInvalidArgument, file + ": its middle has no place in WGS84"};
  }
  middle *= rad_from_deg(1.0);
  const auto geoid = choose_geoid(datum_of(layer, place.crs),
                                  layer.geoid_separation_m,
                                  middle(1, 0),
                                  middle(0, 0),
                                  file,
                                  warnings);
  if (!geoid) return {};
  const Status added = add_separation(*geoid, place.transform, **wgs84_from_crs, window, grid);
  return added ? Status() : Status(added.error().in(file));
}

/// Errors: kInvalidArgument when the file has no posts there, kUnsupported when it has too many.
Status check_window(const PostWindow& window, const std::string& file) {
  if (window.columns < 1 || window.rows < 1) {
    return Error{ErrorCode::kInvalidArgument,
                 file + ": elevation lies nowhere near the imagery; check both georeferences"};
  }
  if (static_cast<double>(window.columns) * window.rows > kMaxPosts) {
    return Error{ErrorCode::kUnsupported,
                 file + ": " + std::to_string(window.columns) + " x " +
                     std::to_string(window.rows) + " posts around the imagery, limit " +
                     std::to_string(static_cast<int>(kMaxPosts)) + "; resample it first"};
  }
  return {};
}

/// Distance between posts on the map at the middle of the fitted area.
double spacing_of(const SmoothMap<2>& post_from_map) {
  const MapRect& area = post_from_map.domain();
  const double x = 0.5 * (area.x_min + area.x_max);
  const double y = 0.5 * (area.y_min + area.y_max);
  const Eigen::Vector2d here = post_from_map(x, y);
  const Eigen::Vector2d east = post_from_map(x + 1.0, y) - here;
  const Eigen::Vector2d north = post_from_map(x, y + 1.0) - here;
  return 1.0 / std::max(east.norm(), north.norm());
}

}  // namespace

Result<ElevationRaster> ElevationRaster::load(const ElevationLayer& layer,
                                              const MapPlane& plane,
                                              const MapRect& area,
                                              std::vector<std::string>& warnings) {
  const std::string file = layer.file.string();
  initialise_gdal();
  GdalMessages messages;
  auto dataset = open_raster(layer.file);
  if (!dataset) return dataset.error();
  auto place = read_georeference(
      **dataset, layer.file, layer.crs, messages.empty() ? std::string() : messages.text());
  if (!place) return place.error();
  const Status whole = check_blocks(**dataset, layer.file);
  if (!whole) return whole.error();
  auto crs_from_wgs84 = CrsTransform::create(wgs84_crs(), place->crs, file);
  if (!crs_from_wgs84) return crs_from_wgs84.error();

  constexpr double kTolerancePosts = 1e-3;
  auto post_from_map =
      SmoothMap<2>::fit(area, posts_of(plane, **crs_from_wgs84, place->transform), kTolerancePosts);
  if (!post_from_map) {
    return Error{ErrorCode::kInvalidArgument,
                 file +
                     ": its coordinate reference system has no smooth relation to the map plane "
                     "around the imagery"};
  }
  const PostWindow window =
      window_over(*post_from_map, (*dataset)->GetRasterXSize(), (*dataset)->GetRasterYSize());
  const Status sane = check_window(window, file);
  if (!sane) return sane.error();
  auto grid = read_posts(**dataset, window, file);
  if (!grid) return grid.error();
  const Status converted = to_ellipsoidal_metres(**dataset, layer, *place, window, *grid, warnings);
  if (!converted) return converted.error();

  ElevationRaster raster{file, std::move(*grid), std::move(*post_from_map), 0.0};
  raster.post_from_map.shift(Eigen::Vector2d(-window.column, -window.row));
  raster.spacing_m = spacing_of(raster.post_from_map);
  return raster;
}

bool ElevationRaster::covers(double x_map_m, double y_map_m) const {
  if (!post_from_map.domain().contains(x_map_m, y_map_m)) return false;
  const Eigen::Vector2d post = post_from_map(x_map_m, y_map_m);
  return post.x() >= -0.5 && post.y() >= -0.5 && post.x() <= grid.columns - 0.5 &&
         post.y() <= grid.rows - 0.5;
}

double ElevationRaster::height_m(double x_map_m, double y_map_m) const {
  if (!covers(x_map_m, y_map_m)) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector2d post = post_from_map(x_map_m, y_map_m);
  return grid.bilinear(post.x(), post.y());
}

}  // namespace overfly::terrain
