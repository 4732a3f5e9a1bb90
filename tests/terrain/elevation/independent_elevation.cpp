#include "tests/terrain/elevation/independent_elevation.hpp"

#include <gdal_priv.h>
#include <proj.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/motion/pose.hpp"

namespace overfly::testing {

struct IndependentElevation::Parts {
  GDALDataset* dataset = nullptr;
  PJ_CONTEXT* context = nullptr;
  PJ* crs_from_wgs84 = nullptr;
  double transform[6] = {};
};

IndependentElevation::IndependentElevation(const std::filesystem::path& file,
                                           const std::string& crs)
    : parts_(std::make_unique<Parts>()) {
  GDALAllRegister();
  parts_->dataset = GDALDataset::Open(file.c_str());
  if (parts_->dataset == nullptr) throw std::runtime_error("cannot open " + file.string());
  parts_->dataset->GetGeoTransform(parts_->transform);
  parts_->context = proj_context_create();
  PJ* raw = proj_create_crs_to_crs(parts_->context, "EPSG:4326", crs.c_str(), nullptr);
  if (raw == nullptr) throw std::runtime_error("PROJ cannot reach " + crs);
  parts_->crs_from_wgs84 = proj_normalize_for_visualization(parts_->context, raw);
  proj_destroy(raw);
}

IndependentElevation::~IndependentElevation() {
  proj_destroy(parts_->crs_from_wgs84);
  proj_context_destroy(parts_->context);
  GDALClose(parts_->dataset);
}

double IndependentElevation::value_at(double lat_rad, double lon_rad) const {
  const PJ_COORD place = proj_coord(deg_from_rad(lon_rad), deg_from_rad(lat_rad), 0.0, 0.0);
  const PJ_COORD in_crs = proj_trans(parts_->crs_from_wgs84, PJ_FWD, place);
  const double* g = parts_->transform;
  const double u = (in_crs.xy.x - g[0]) / g[1] - 0.5;
  const double v = (in_crs.xy.y - g[3]) / g[5] - 0.5;
  const int i = static_cast<int>(std::floor(u));
  const int j = static_cast<int>(std::floor(v));
  double posts[4] = {};
  GDALRasterBand* band = parts_->dataset->GetRasterBand(1);
  if (band->RasterIO(GF_Read, i, j, 2, 2, posts, 2, 2, GDT_Float64, 0, 0, nullptr) != CE_None) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double nodata = band->GetNoDataValue();
  for (const double post : posts) {
    if (post == nodata) return std::numeric_limits<double>::quiet_NaN();
  }
  const double s = u - i;
  const double t = v - j;
  return (1 - s) * (1 - t) * posts[0] + s * (1 - t) * posts[1] + (1 - s) * t * posts[2] +
         s * t * posts[3];
}

}  // namespace overfly::testing
