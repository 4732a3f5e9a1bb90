// A checkerboard on the ground as GeoTIFFs, and where a camera must see its corners: computed
// with GDAL, PROJ and OpenCV only.
#pragma once

#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/earth/geodesy.hpp"
#include "core/motion/pose.hpp"

namespace overfly::testing {

struct CheckerboardSpec {
  int epsg = 32616;  ///< a UTM zone
  double left_m = 0.0, top_m = 0.0;
  double texel_m = 0.5;
  int texels = 1536;  ///< side of the image
  int texels_per_square = 16;
  bool pixel_is_point = false;
  double base_height_m = 150.0;  ///< above the ellipsoid
  double relief_m = 0.0;         ///< amplitude of the hills

  [[nodiscard]] double height_m(double x_m, double y_m) const;
};

/// Writes board.tif and ground.tif (posts every 2 m) into a folder.
void write_checkerboard(const CheckerboardSpec& spec, const std::filesystem::path& folder);

/// The board's inner corners in earth-centred coordinates, row by row.
[[nodiscard]] std::vector<cv::Point3d> corners_ecef(const CheckerboardSpec& spec);

/// A geodetic position in earth-centred coordinates, by PROJ.
[[nodiscard]] cv::Point3d ecef_by_proj(double lat_deg, double lon_deg, double alt_ellipsoid_m);
/// Latitude and longitude of a map position [deg], by PROJ.
[[nodiscard]] cv::Point2d lat_lon_by_proj(int epsg, double x_m, double y_m);

/// Pixels of earth-centred points in a nadir-mounted camera (image top = nose), by OpenCV. The
/// attitude is relative to north-east-down at the frame's origin.
[[nodiscard]] std::vector<cv::Point2d> project_by_opencv(const std::vector<cv::Point3d>& points,
                                                         const cv::Point3d& camera_ecef,
                                                         double origin_lat_rad,
                                                         double origin_lon_rad,
                                                         const RollPitchYaw& attitude,
                                                         const PinholeCamera& camera);

}  // namespace overfly::testing
