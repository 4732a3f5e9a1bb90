#include "tests/renderer/checkerboard_world.hpp"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <stdexcept>
#include <string>

namespace overfly::testing {

namespace {

using Transformation = std::unique_ptr<OGRCoordinateTransformation>;

Transformation transformation(int from_epsg, int to_epsg) {
  OGRSpatialReference from, to;
  if (from.importFromEPSG(from_epsg) != OGRERR_NONE || to.importFromEPSG(to_epsg) != OGRERR_NONE) {
    throw std::runtime_error("PROJ knows no EPSG:" + std::to_string(from_epsg));
  }
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return Transformation(OGRCreateCoordinateTransformation(&from, &to));
}

GDALDataset* create(const std::filesystem::path& file,
                    int side,
                    GDALDataType type,
                    const CheckerboardSpec& spec,
                    double texel_m) {
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  GDALDataset* dataset = driver->Create(file.c_str(), side, side, 1, type, nullptr);
  if (dataset == nullptr) throw std::runtime_error("cannot create " + file.string());
  if (spec.pixel_is_point) dataset->SetMetadataItem("AREA_OR_POINT", "Point");
  double transform[6] = {spec.left_m, texel_m, 0.0, spec.top_m, 0.0, -texel_m};
  dataset->SetGeoTransform(transform);
  OGRSpatialReference reference;
  reference.importFromEPSG(spec.epsg);
  dataset->SetSpatialRef(&reference);
  return dataset;
}

template <typename T>
void write(GDALDataset* dataset, std::vector<T>& values, GDALDataType type) {
  const int side = dataset->GetRasterXSize();
  const CPLErr error = dataset->GetRasterBand(1)->RasterIO(
      GF_Write, 0, 0, side, side, values.data(), side, side, type, 0, 0, nullptr);
  GDALClose(dataset);
  if (error != CE_None) throw std::runtime_error("GDAL cannot write");
}

/// Rotation about one axis by OpenCV.
cv::Matx33d rotation(double x, double y, double z) {
  cv::Matx33d matrix;
  cv::Rodrigues(cv::Vec3d(x, y, z), matrix);
  return matrix;
}

}  // namespace

double CheckerboardSpec::height_m(double x_m, double y_m) const {
  return base_height_m +
         relief_m * std::sin((x_m - left_m) / 70.0) * std::cos((y_m - top_m) / 90.0);
}

void write_checkerboard(const CheckerboardSpec& spec, const std::filesystem::path& folder) {
  std::vector<std::uint8_t> board(static_cast<std::size_t>(spec.texels) * spec.texels);
  for (int row = 0; row < spec.texels; ++row) {
    for (int column = 0; column < spec.texels; ++column) {
      const bool bright = (row / spec.texels_per_square + column / spec.texels_per_square) % 2 == 0;
      board[static_cast<std::size_t>(row) * spec.texels + column] = bright ? 220 : 30;
    }
  }
  write(create(folder / "board.tif", spec.texels, GDT_Byte, spec, spec.texel_m), board, GDT_Byte);

  constexpr double kPostM = 2.0;
  const int side = static_cast<int>(spec.texels * spec.texel_m / kPostM);
  std::vector<float> heights;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      heights.push_back(static_cast<float>(
          spec.height_m(spec.left_m + (column + 0.5) * kPostM, spec.top_m - (row + 0.5) * kPostM)));
    }
  }
  write(create(folder / "ground.tif", side, GDT_Float32, spec, kPostM), heights, GDT_Float32);
}

cv::Point2d lat_lon_by_proj(int epsg, double x_m, double y_m) {
  transformation(epsg, 4326)->Transform(1, &x_m, &y_m);
  return {y_m, x_m};
}

cv::Point3d ecef_by_proj(double lat_deg, double lon_deg, double alt_ellipsoid_m) {
  double x = lon_deg, y = lat_deg, z = alt_ellipsoid_m;
  transformation(4979, 4978)->Transform(1, &x, &y, &z);
  return {x, y, z};
}

std::vector<cv::Point3d> corners_ecef(const CheckerboardSpec& spec) {
  const Transformation geodetic = transformation(spec.epsg, 4326);
  const Transformation ecef = transformation(4979, 4978);
  std::vector<cv::Point3d> corners;
  for (int row = spec.texels_per_square; row < spec.texels; row += spec.texels_per_square) {
    for (int column = spec.texels_per_square; column < spec.texels;
         column += spec.texels_per_square) {
      double x = spec.left_m + column * spec.texel_m;
      double y = spec.top_m - row * spec.texel_m;
      double z = spec.height_m(x, y);
      geodetic->Transform(1, &x, &y);
      ecef->Transform(1, &x, &y, &z);
      corners.emplace_back(x, y, z);
    }
  }
  return corners;
}

std::vector<cv::Point2d> project_by_opencv(const std::vector<cv::Point3d>& points,
                                           const cv::Point3d& camera_ecef,
                                           double origin_lat_rad,
                                           double origin_lon_rad,
                                           const RollPitchYaw& attitude,
                                           const PinholeCamera& camera) {
  const double sf = std::sin(origin_lat_rad), cf = std::cos(origin_lat_rad);
  const double sl = std::sin(origin_lon_rad), cl = std::cos(origin_lon_rad);
  // Columns: north, east, down.
  const cv::Matx33d R_ecef_ned(-sf * cl, -sl, -cf * cl, -sf * sl, cl, -cf * sl, cf, 0.0, -sf);
  const cv::Matx33d R_ned_body = rotation(0, 0, attitude.yaw_rad) *
                                 rotation(0, attitude.pitch_rad, 0) *
                                 rotation(attitude.roll_rad, 0, 0);
  const cv::Matx33d R_body_camera(0, -1, 0, 1, 0, 0, 0, 0, 1);
  const cv::Matx33d R_camera_ecef = (R_ecef_ned * R_ned_body * R_body_camera).t();
  cv::Vec3d rotation_vector;
  cv::Rodrigues(R_camera_ecef, rotation_vector);
  std::vector<cv::Point3d> relative;
  for (const cv::Point3d& point : points) relative.push_back(point - camera_ecef);
  const cv::Matx33d K(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(relative, rotation_vector, cv::Vec3d(), K, cv::noArray(), pixels);
  return pixels;
}

}  // namespace overfly::testing
