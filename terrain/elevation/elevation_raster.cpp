#include "terrain/elevation/elevation_raster.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/motion/pose.hpp"
#include "terrain/elevation/elevation_units.hpp"
#include "terrain/place/datum_shift.hpp"
#include "terrain/place/geoid.hpp"
#include "terrain/place/place_doubt.hpp"
#include "terrain/place/raster_turns.hpp"
#include "terrain/raster/file_soundness.hpp"
#include "terrain/raster/raster_bands.hpp"

namespace overfly::terrain {
namespace {

/// Nodes per side of the lattice that holds the geoid's separation.
constexpr int kLatticeNodes = 65;

PlaneFunction posts_of(const MapPlane& plane,
                       const CrsTransform& crs_from_wgs84,
                       const GeoTransform& transform,
                       const std::optional<Turn>& turn) {
  return [&plane, &crs_from_wgs84, transform, turn](const Eigen::Matrix2Xd& points,
                                                    Eigen::MatrixXd& values) {
    Eigen::Matrix2Xd crs_points = points;
    if (!plane.to_crs(crs_from_wgs84, crs_points)) return false;
    values.resize(2, points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      if (turn) turn->apply(crs_points(0, i));
      transform.pixel_from_crs(crs_points(0, i), crs_points(1, i), values(0, i), values(1, i));
    }
    values.array() -= 0.5;  // posts are pixel centres
    return true;
  };
}

/// The transform of a raster that consists of every step-th pixel of a row and of a column. GDAL
/// takes pixels step / 2 (rounded down), step + step / 2 ..., so that for an even step their
/// centres lie half a pixel beyond the middle of `step` pixels.
GeoTransform thinned(const GeoTransform& all, int step) {
  GeoTransform some = all;
  const double shift = step % 2 == 0 ? 0.5 : 0.0;
  all.crs_from_pixel(shift, shift, some.g[0], some.g[3]);
  for (const int i : {1, 2, 4, 5}) some.g[i] *= step;
  return some;
}

/// Number of the file's columns around the earth; empty if it has fewer.
std::optional<int> columns_around(const std::optional<Turn>& turn,
                                  const GeoTransform& transform,
                                  int file_columns) {
  if (!turn || transform.g[2] != 0.0 || transform.g[4] != 0.0) return std::nullopt;
  const double columns = turn->length / std::abs(transform.g[1]);
  constexpr double kTolerance = 1e-3;
  if (columns > file_columns + kTolerance) return std::nullopt;
  if (std::abs(columns - std::round(columns)) > kTolerance) return std::nullopt;
  return static_cast<int>(std::lround(columns));
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

/// The lattice of separations over posts [column, column + columns) x [row, row + rows).
Result<HeightGrid> separation_lattice(const GeoidModel& model,
                                      const GeoTransform& transform,
                                      const CrsTransform& wgs84_from_crs,
                                      const Eigen::Vector4d& window,
                                      const std::string& file) {
  Eigen::Matrix2Xd points(2, kLatticeNodes * kLatticeNodes);
  for (int j = 0; j < kLatticeNodes; ++j) {
    for (int i = 0; i < kLatticeNodes; ++i) {
      const double px = window[0] + 0.5 + (window[2] - 1.0) * i / (kLatticeNodes - 1);
      const double py = window[1] + 0.5 + (window[3] - 1.0) * j / (kLatticeNodes - 1);
      const Eigen::Index at = static_cast<Eigen::Index>(j) * kLatticeNodes + i;
      transform.crs_from_pixel(px, py, points(0, at), points(1, at));
    }
  }
  if (!wgs84_from_crs.apply(points)) {
    return Error{ErrorCode::kInvalidArgument, file + ": posts cannot be transformed to WGS84"};
  }
  const Eigen::VectorXd separation = geoid_separation_m(model, points * rad_from_deg(1.0));
  HeightGrid lattice;
  lattice.columns = kLatticeNodes;
  lattice.rows = kLatticeNodes;
  lattice.heights_m.assign(separation.data(), separation.data() + separation.size());
  return lattice;
}

std::string relation_of(const std::optional<GeoidModel>& geoid) {
  if (!geoid) return "heights as they are";
  if (!geoid->grid.empty()) return geoid->grid;
  if (geoid->constant_m) return "constant " + std::to_string(*geoid->constant_m);
  return "built-in table";
}

}  // namespace

Result<std::shared_ptr<ElevationRaster>> ElevationRaster::open(const ElevationLayer& layer,
                                                               const MapPlane& plane,
                                                               const MapRect& area,
                                                               std::shared_ptr<BlockCache> cache,
                                                               int step,
                                                               std::vector<std::string>& warnings) {
  auto raster = std::make_shared<ElevationRaster>();
  raster->file_ = layer.file.string();
  initialise_gdal();
  GdalMessages messages;
  auto opened = open_raster(layer.file);
  if (!opened) return opened.error();
  GDALDataset& dataset = **opened;
  raster->step_ = std::clamp(step, 1, std::min(dataset.GetRasterXSize(), dataset.GetRasterYSize()));
  raster->file_columns_ = dataset.GetRasterXSize() / raster->step_;
  raster->file_rows_ = dataset.GetRasterYSize() / raster->step_;
  auto place = read_georeference(
      dataset, layer.file, layer.crs, messages.empty() ? std::string() : messages.text());
  if (!place) return place.error();
  if (raster->step_ > 1) place->transform = thinned(place->transform, raster->step_);
  Status good = check_height_band(dataset, raster->file_, warnings);
  if (good) good = raster->find_window(plane, area, *place);
  if (good) good = raster->find_conversion(dataset, layer, *place, warnings);
  if (!good) return good.error();
  if (!messages.empty()) warnings.push_back(heard_while_opening(layer.file, messages));
  raster->pool_ = std::make_unique<DatasetPool>(layer.file, 0, std::move(*opened));
  raster->page_posts(std::move(cache));
  return raster;
}

void ElevationRaster::page_posts(std::shared_ptr<BlockCache> cache) {
  cache_ = cache;
  posts_ = std::make_unique<PagedHeights>(
      window_.columns,
      window_.rows,
      std::move(cache),
      [this](int, int column, int row) -> Result<HeightGrid> { return posts_block(column, row); });
}

Status ElevationRaster::check(const Cancelled& cancelled,
                              std::vector<std::string>& warnings) const {
  auto dataset = pool_->take();
  if (!dataset) return dataset.error();
  Status whole = check_whole(**dataset, file_, cancelled, warnings);
  pool_->put(std::move(*dataset));
  return whole;
}

/// The places of imagery and elevation, for an error message.
std::string ElevationRaster::places_of(const MapPlane& plane,
                                       const MapRect& area,
                                       const Georeference& place) const {
  Eigen::Matrix2Xd imagery(2, 1);
  imagery << 0.5 * (area.x_min + area.x_max), 0.5 * (area.y_min + area.y_max);
  Eigen::Matrix2Xd posts(2, 1);
  place.transform.crs_from_pixel(0.5 * file_columns_, 0.5 * file_rows_, posts(0, 0), posts(1, 0));
  const auto to_wgs84 = CrsTransform::create(place.crs, wgs84_crs(), file_);
  if (!to_wgs84 || !plane.geodetic_from_map(imagery) || !(*to_wgs84)->apply(posts)) return "";
  char text[160];
  std::snprintf(text,
                sizeof(text),
                " (imagery around %.3f deg N, %.3f deg E; elevation around %.3f deg N, %.3f deg E)",
                deg_from_rad(imagery(1, 0)),
                deg_from_rad(imagery(0, 0)),
                posts(1, 0),
                posts(0, 0));
  return text;
}

/// The posts between two corners, with a margin.
void ElevationRaster::set_window(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  constexpr double kMargin = 4.0;
  const auto clamped = [](double value, int size) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(size)));
  };
  window_.row = clamped(std::floor(low.y() - kMargin), file_rows_);
  window_.rows = clamped(std::ceil(high.y() + kMargin), file_rows_) - window_.row;
  const double left = std::floor(low.x() - kMargin);
  const double right = std::ceil(high.x() + kMargin);
  if (columns_around_) {
    window_.column = static_cast<int>(left);
    window_.columns = clamped(right - left, *columns_around_);
  } else {
    window_.column = clamped(left, file_columns_);
    window_.columns = clamped(right, file_columns_) - window_.column;
  }
}

std::pair<Eigen::Vector2d, Eigen::Vector2d> ElevationRaster::post_bounds(
    const MapRect& area) const {
  Eigen::Vector2d low(1e18, 1e18);
  Eigen::Vector2d high(-1e18, -1e18);
  constexpr int kSteps = 32;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const Eigen::Vector2d post =
          (*post_from_map_)(area.x_min + (area.x_max - area.x_min) * i / kSteps,
                            area.y_min + (area.y_max - area.y_min) * j / kSteps);
      low = low.cwiseMin(post);
      high = high.cwiseMax(post);
    }
  }
  return {low, high};
}

Status ElevationRaster::find_window(const MapPlane& plane,
                                    const MapRect& area,
                                    const Georeference& place) {
  auto crs_from_wgs84 = CrsTransform::create(wgs84_crs(), place.crs, file_);
  if (!crs_from_wgs84) return crs_from_wgs84.error();
  const auto turns = turns_over(plane, area, place, file_columns_, file_rows_, file_);
  if (!turns) return turns.error();
  const std::optional<Turn>& turn = turns->front();
  columns_around_ = columns_around(turn, place.transform, file_columns_);
  constexpr double kTolerancePosts = 1e-3;
  post_from_map_ = SmoothMap<2>::fit(
      area, posts_of(plane, **crs_from_wgs84, place.transform, turn), kTolerancePosts);
  if (!post_from_map_) {
    return Error{ErrorCode::kInvalidArgument,
                 file_ +
                     ": its coordinate reference system has no smooth relation to the map plane "
                     "around the imagery"};
  }
  const auto [low, high] = post_bounds(area);
  whereabouts_ = places_of(plane, area, place);
  set_window(low, high);
  if (window_.columns < 1 || window_.rows < 1) {
    return Error{ErrorCode::kInvalidArgument,
                 file_ + ": elevation lies nowhere near the imagery; check both georeferences" +
                     whereabouts_};
  }
  post_from_map_->shift(Eigen::Vector2d(-window_.column, -window_.row));
  spacing_m_ = spacing_of(*post_from_map_);
  return {};
}

Status ElevationRaster::find_conversion(GDALDataset& dataset,
                                        const ElevationLayer& layer,
                                        const Georeference& place,
                                        std::vector<std::string>& warnings) {
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  const double unit_m = height_unit_m(dataset, layer, place.crs, warnings);
  scale_m_ = band.GetScale() * unit_m;
  offset_m_ = band.GetOffset() * unit_m;
  int has_nodata = 0;
  const double nodata = band.GetNoDataValue(&has_nodata);
  if (has_nodata != 0) nodata_ = nodata;
  if (layer.nodata) nodata_ = layer.nodata;
  trusted_ = layer.nodata.has_value();
  masked_ = !layer.nodata && (band.GetMaskFlags() & (GMF_ALL_VALID | GMF_NODATA)) == 0;
  has_overviews_ = !layer.nodata && (masked_ || has_nodata != 0) && band.GetOverviewCount() > 0;

  auto wgs84_from_crs = CrsTransform::create(place.crs, wgs84_crs(), file_);
  if (!wgs84_from_crs) return wgs84_from_crs.error();
  Eigen::Matrix2Xd middle(2, 1);
  place.transform.crs_from_pixel(window_.column + 0.5 * window_.columns,
                                 window_.row + 0.5 * window_.rows,
                                 middle(0, 0),
                                 middle(1, 0));
  if (auto doubt = place_doubt(place, file_columns_, file_rows_, file_)) {
    warnings.push_back(std::move(*doubt));
  }
  if (auto doubt = datum_shift_doubt(place.crs, middle(0, 0), middle(1, 0), file_)) {
    warnings.push_back(std::move(*doubt));
  }
  if (!(*wgs84_from_crs)->apply(middle)) {
    return Error{ErrorCode::kInvalidArgument,
                 file_ + ": its centre cannot be transformed to WGS84"};
  }
  middle *= rad_from_deg(1.0);
  datum_ = height_datum(layer, place.crs);
  const auto geoid = choose_geoid(datum_.datum,
                                  layer.geoid_separation_m,
                                  middle(1, 0),
                                  middle(0, 0),
                                  file_,
                                  warnings,
                                  datum_.named);
  relation_ = relation_of(geoid);
  if (!geoid) return {};
  auto lattice = separation_lattice(
      *geoid,
      place.transform,
      **wgs84_from_crs,
      Eigen::Vector4d(window_.column, window_.row, window_.columns, window_.rows),
      file_);
  if (!lattice) return lattice.error();
  separation_m_ = std::move(*lattice);
  return {};
}

bool ElevationRaster::covers(double x_map_m, double y_map_m) const {
  if (!post_from_map_->domain().contains(x_map_m, y_map_m)) return false;
  const Eigen::Vector2d post = (*post_from_map_)(x_map_m, y_map_m);
  return post.x() >= -0.5 && post.y() >= -0.5 && post.x() <= window_.columns - 0.5 &&
         post.y() <= window_.rows - 0.5;
}

double ElevationRaster::overlap_share(const MapRect& area) const {
  const auto [low, high] = post_bounds(area);
  const double columns = std::min(high.x(), window_.columns - 0.5) - std::max(low.x(), -0.5);
  const double rows = std::min(high.y(), window_.rows - 0.5) - std::max(low.y(), -0.5);
  if (columns <= 0.0 || rows <= 0.0) return 0.0;
  return columns * rows / (high - low).prod();
}

double ElevationRaster::height_m(double x_map_m, double y_map_m) const {
  if (!covers(x_map_m, y_map_m)) return std::numeric_limits<double>::quiet_NaN();
  // A place that is a post but for rounding gets its height, whatever its neighbours are.
  const auto whole_if_close = [](double value) {
    constexpr double kClosePosts = 1e-5;
    const double whole = std::round(value);
    return std::abs(value - whole) < kClosePosts ? whole : value;
  };
  const Eigen::Vector2d post = (*post_from_map_)(x_map_m, y_map_m);
  return posts_->bilinear(0, whole_if_close(post.x()), whole_if_close(post.y()));
}

}  // namespace overfly::terrain
