#include "terrain/place/geoid.hpp"

#include <proj.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>

#include "core/motion/pose.hpp"
#include "terrain/place/geoid_table.hpp"
#include "terrain/place/proj_handles.hpp"

namespace overfly::terrain {
namespace {

/// A vertical grid shift of PROJ with a separate context.
class GridShift {
 public:
  explicit GridShift(const std::string& grid) : context_(proj_context_create()) {
    proj_log_level(context_.get(), PJ_LOG_NONE);
    const std::string definition = "+proj=vgridshift +grids=" + grid + " +multiplier=1";
    transform_.reset(proj_create(context_.get(), definition.c_str()));
  }
  /// NaN if the grid has no value.
  [[nodiscard]] double at(double lon_rad, double lat_rad) const {
    if (!transform_) return std::nan("");
    const PJ_COORD place = proj_coord(lon_rad, lat_rad, 0.0, 0.0);
    const PJ_COORD shifted = proj_trans(transform_.get(), PJ_FWD, place);
    return std::isfinite(shifted.lpz.z) ? shifted.lpz.z : std::nan("");
  }

 private:
  ProjContext context_;
  ProjObject transform_;
};

/// The names under which PROJ distributes each datum's grid, best first.
std::vector<std::string> grids_of(VerticalDatum datum) {
  switch (datum) {
    case VerticalDatum::kEgm96:
      return {"us_nga_egm96_15.tif", "egm96_15.gtx"};
    case VerticalDatum::kEgm2008:
      return {"us_nga_egm08_25.tif", "egm08_25.gtx"};
    case VerticalDatum::kNavd88:
      return {"us_noaa_g2018u0.tif",
              "us_noaa_g2018a0.tif",
              "us_noaa_g2012bu0.tif",
              "us_noaa_geoid09_conus.tif",
              "g2012a_conus.gtx",
              "geoid09_conus.gtx"};
    case VerticalDatum::kEllipsoid:
    case VerticalDatum::kUnknown:
      break;
  }
  return {};
}

/// The file that PROJ opens for a grid; a file of an older name may replace the requested one.
std::string file_of_grid(const std::string& grid) {
  // PROJ uses its default context there, which serves one thread at a time.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const PJ_GRID_INFO info = proj_grid_info(grid.c_str());
  const std::string file = std::filesystem::path(info.filename).filename().string();
  return file.empty() ? grid : file;
}

std::optional<std::string> installed_grid(VerticalDatum datum, double lat_rad, double lon_rad) {
  for (const std::string& grid : grids_of(datum)) {
    if (std::isfinite(GridShift(grid).at(lon_rad, lat_rad))) return file_of_grid(grid);
  }
  return std::nullopt;
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f", value);
  return text;
}

std::string unknown_datum_text(const std::string& named, double separation_m) {
  return (named.empty() ? "vertical datum is not given"
                        : "vertical datum \"" + named + "\" is unknown") +
         "; heights are assumed to be ellipsoidal. If they are above sea level, the ground is "
         "wrong by "
         "about " +
         rounded(std::abs(separation_m)) + " m here: set \"vertical_datum\" in the manifest";
}

}  // namespace

const char* to_string(VerticalDatum datum) {
  switch (datum) {
    case VerticalDatum::kEllipsoid:
      return "ellipsoid";
    case VerticalDatum::kEgm96:
      return "egm96";
    case VerticalDatum::kEgm2008:
      return "egm2008";
    case VerticalDatum::kNavd88:
      return "navd88";
    case VerticalDatum::kUnknown:
      break;
  }
  return "unknown";
}

std::optional<GeoidModel> choose_geoid(VerticalDatum datum,
                                       std::optional<double> constant_m,
                                       double lat_rad,
                                       double lon_rad,
                                       const std::string& file,
                                       std::vector<std::string>& warnings,
                                       const std::string& named) {
  if (datum == VerticalDatum::kEllipsoid) return std::nullopt;
  if (datum == VerticalDatum::kUnknown) {
    if (constant_m) return GeoidModel{"", constant_m, false};
    warnings.push_back(file + ": " + unknown_datum_text(named, egm96_table_m(lat_rad, lon_rad)));
    return std::nullopt;
  }
  if (auto grid = installed_grid(datum, lat_rad, lon_rad)) return GeoidModel{*grid, {}, false};
  const std::string name = to_string(datum);
  if (constant_m) return GeoidModel{"", constant_m, false};
  if (auto grid = installed_grid(VerticalDatum::kEgm96, lat_rad, lon_rad)) {
    warnings.push_back(file + ": no PROJ grid for " + name +
                       " is installed; EGM96 is used instead (" + *grid +
                       "): heights may be wrong by about 2 m");
    return GeoidModel{*grid, {}, false};
  }
  warnings.push_back(file + ": no PROJ grid for " + name +
                     " is installed; the built-in table of EGM96 every " +
                     std::to_string(kEgm96TableStepDeg) +
                     " degrees is used instead: heights may be wrong by about " +
                     std::to_string(kEgm96TableErrorM) + " m");
  return GeoidModel{"", {}, true};
}

Eigen::VectorXd geoid_separation_m(const GeoidModel& model, const Eigen::Matrix2Xd& lon_lat_rad) {
  Eigen::VectorXd result(lon_lat_rad.cols());
  if (model.constant_m) {
    result.setConstant(*model.constant_m);
    return result;
  }
  const std::optional<GridShift> shift =
      model.built_in ? std::nullopt : std::optional<GridShift>(std::in_place, model.grid);
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    const double lon_rad = lon_lat_rad(0, i);
    const double lat_rad = lon_lat_rad(1, i);
    double value = shift ? shift->at(lon_rad, lat_rad) : std::nan("");
    // A regional grid may cover only a part of a large raster.
    if (!std::isfinite(value)) value = egm96_table_m(lat_rad, lon_rad);
    result[i] = value;
  }
  return result;
}

}  // namespace overfly::terrain
