#include "terrain/raster/georeference.hpp"

#include <cmath>
#include <cstdio>

#include "terrain/raster/crs_text.hpp"
#include "terrain/raster/gdal_messages.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;

void GeoTransform::crs_from_pixel(double px, double py, double& x, double& y) const {
  x = g[0] + g[1] * px + g[2] * py;
  y = g[3] + g[4] * px + g[5] * py;
}

void GeoTransform::pixel_from_crs(double x, double y, double& px, double& py) const {
  const double determinant = g[1] * g[5] - g[2] * g[4];
  const double dx = x - g[0];
  const double dy = y - g[3];
  px = (g[5] * dx - g[2] * dy) / determinant;
  py = (g[1] * dy - g[4] * dx) / determinant;
}

namespace {

/// Corner coordinates that do not exist on earth show that transform and CRS do not match.
Status check_range(const Georeference& place, int width, int height, const std::string& file) {
  for (int corner = 0; corner < 4; ++corner) {
    double x = 0.0;
    double y = 0.0;
    place.transform.crs_from_pixel((corner & 1) * width, (corner >> 1) * height, x, y);
    const bool geographic = place.crs.IsGeographic() != 0;
    const double unit = geographic ? place.crs.GetAngularUnits() : place.crs.GetLinearUnits();
    // Columns may begin anywhere in a turn and repeat the first one; posts may lie at the poles,
    // with their pixels half beyond.
    constexpr double kTolerance = 1e-3;
    const double* g = place.transform.g;
    const double column = (std::abs(g[1]) + std::abs(g[2])) * unit;
    const double row = (std::abs(g[4]) + std::abs(g[5])) * unit;
    const double limit_x = geographic ? 3.0 * M_PI + column + kTolerance : 5e7;
    const double limit_y = geographic ? 0.5 * M_PI + 0.5 * row + kTolerance : 5e7;
    if (!(std::abs(x * unit) <= limit_x) || !(std::abs(y * unit) <= limit_y)) {
      return Error{ErrorCode::kInvalidArgument,
                   file + ": georeference is invalid: a corner lies at (" + std::to_string(x) +
                       ", " + std::to_string(y) + "), outside its coordinate reference system"};
    }
  }
  return {};
}

Error no_place(GDALDataset& dataset, const std::string& file, const std::string& heard) {
  const int points = dataset.GetGCPCount();
  if (points > 0) {
    return {ErrorCode::kInvalidArgument,
            file + ": has no georeference, only " + std::to_string(points) +
                " ground control points" + heard +
                "; rectify it first, for example with `gdalwarp IN.tif OUT.tif`"};
  }
  return {ErrorCode::kInvalidArgument,
          file + ": has no georeference (no position and pixel size)" + heard};
}

}  // namespace

Result<Georeference> read_georeference(GDALDataset& dataset,
                                       const fs::path& file,
                                       const std::optional<std::string>& crs_override,
                                       const std::string& said) {
  const std::string heard = said.empty() ? "" : " (GDAL reported: " + said + ")";
  Georeference place;
  if (dataset.GetGeoTransform(place.transform.g) != CE_None) {
    return no_place(dataset, file.string(), heard);
  }
  const double* g = place.transform.g;
  if (const double area = g[1] * g[5] - g[2] * g[4]; !std::isfinite(area) || area == 0.0) {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() + ": georeference is degenerate: pixel size (" +
                     std::to_string(g[1]) + ", " + std::to_string(g[5]) + ")"};
  }
  const OGRSpatialReference* crs = dataset.GetSpatialRef();
  // A local system (of a building site, a game) has no known place on the earth.
  const bool local = crs != nullptr && crs->IsLocal() != 0;
  if (crs != nullptr && !crs->IsEmpty() && !local) {
    place.crs = *crs;
  } else if (crs_override) {
    if (Status status = check_crs_text(*crs_override, file.string() + ": crs"); !status) {
      return status.error();
    }
    const GdalMessages messages;
    if (place.crs.SetFromUserInput(crs_override->c_str(),
                                   OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) !=
        OGRERR_NONE) {
      return Error{ErrorCode::kInvalidArgument,
                   file.string() + ": crs = \"" + *crs_override +
                       "\" is not a known coordinate reference system: " + messages.text()};
    }
  } else {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() +
                     (local ? ": coordinate reference system is a local one without a place on the "
                              "earth"
                            : ": has no coordinate reference system") +
                     heard + "; set it in the manifest's field \"crs\", for example \"EPSG:4326\""};
  }
  if (place.crs.IsProjected() == 0 && place.crs.IsGeographic() == 0) {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() +
                     ": coordinate reference system is neither projected nor "
                     "geographic, so its place on the earth is unknown; convert it, for example "
                     "with `gdalwarp -t_srs EPSG:4326 IN.tif OUT.tif`"};
  }
  place.crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const Status in_range =
      check_range(place, dataset.GetRasterXSize(), dataset.GetRasterYSize(), file.string());
  if (!in_range) return in_range.error();
  const Status sized = check_pixel_size(place, file.string());
  if (!sized) return sized.error();
  return place;
}

Status check_pixel_size(const Georeference& place, const std::string& file) {
  const double* g = place.transform.g;
  constexpr double kEarthRadiusM = 6371e3;
  const double unit_m = place.crs.IsGeographic() != 0 ? place.crs.GetAngularUnits() * kEarthRadiusM
                                                      : place.crs.GetLinearUnits();
  for (const double size_m : {std::hypot(g[1], g[4]) * unit_m, std::hypot(g[2], g[5]) * unit_m}) {
    if (size_m >= 1e-3 && size_m <= 100e3) continue;
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g", size_m);
    const char* name = nullptr;
    if (place.crs.IsGeographic() != 0) {
      (void)place.crs.GetAngularUnits(&name);
    } else {
      (void)place.crs.GetLinearUnits(&name);
    }
    return Error{ErrorCode::kInvalidArgument,
                 file + ": pixels are " + text +
                     " m on the ground: must be in [0.001, 100000]; is its georeference in the "
                     "unit of its coordinate reference system (" +
                     (name != nullptr ? name : "unknown") + ")?"};
  }
  return {};
}

}  // namespace overfly::terrain
