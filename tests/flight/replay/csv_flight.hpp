// A flight of 90 s as CSV files with a mapping: a weaving climb, sampled without noise.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <string>

#include "core/earth/geodesy.hpp"
#include "core/motion/pose.hpp"
#include "core/text/number_text.hpp"
#include "flight/logs/ned_attitude.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::testing {

using overfly::testing::read_text;
using overfly::testing::source_file;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;

class CsvFlight {
 public:
  struct Row {
    double lat_deg = 0.0;
    double lon_deg = 0.0;
    double alt_msl_m = 0.0;
    RollPitchYaw angles;
    Eigen::Quaterniond R_ned_body;
  };

  /// @param erratic  the position at 150 s lies further north
  explicit CsvFlight(bool erratic = false, double erratic_deg = 0.001) {
    std::string gps = "t,lat,lon,alt\n";
    for (int i = 0; i <= 450; ++i) {
      const double t_s = 100.0 + 0.2 * i;
      const Row at = row(t_s);
      const double off_deg = erratic && i == 250 ? erratic_deg : 0.0;
      gps += number_text(t_s) + ',' + number_text(at.lat_deg + off_deg) + ',' +
             number_text(at.lon_deg) + ',' + number_text(at.alt_msl_m) + '\n';
    }
    std::string attitude = "t,roll,pitch,yaw\n";
    for (int i = 0; i <= 1800; ++i) {
      const double t_s = 100.0 + 0.05 * i;
      const RollPitchYaw angles = row(t_s).angles;
      attitude += number_text(t_s) + ',' + number_text(angles.roll_rad) + ',' +
                  number_text(angles.pitch_rad) + ',' + number_text(angles.yaw_rad) + '\n';
    }
    write_text(folder_.path() / "gps.csv", gps);
    write_text(folder_.path() / "att.csv", attitude);
    write_text(mapping(), R"({"csv_mapping_version": 1, "pieces": [
      {"name": "GPS", "file": "gps.csv", "origin": "gps", "time": {"column": "t", "unit": "s"},
       "columns": {"lat": {"column": "lat", "unit": "deg"}, "lon": {"column": "lon", "unit": "deg"},
                   "alt_msl": {"column": "alt", "unit": "m"}}},
      {"name": "ATT", "file": "att.csv", "origin": "estimate",
       "time": {"column": "t", "unit": "s"},
       "columns": {"roll": {"column": "roll", "unit": "rad"},
                   "pitch": {"column": "pitch", "unit": "rad"},
                   "yaw": {"column": "yaw", "unit": "rad"}}}]})");
  }

  [[nodiscard]] std::filesystem::path mapping() const { return folder_.path() / "log.json"; }

  /// The truth at a time of the vehicle's clock, 100 s to 190 s.
  [[nodiscard]] Row row(double t_s) const {
    const double s = t_s - 100.0;
    const Eigen::Vector3d p(20.0 * s, 60.0 * std::sin(0.3 * s), 100.0 + 0.5 * s);
    const Geodetic point = frame_.geodetic_from_world(p);
    Row at;
    at.lat_deg = deg_from_rad(point.lat_rad);
    at.lon_deg = deg_from_rad(point.lon_rad);
    at.alt_msl_m = point.alt_ellipsoid_m;
    const double north_m_s = 18.0 * std::cos(0.3 * s);
    const double turn_rad_s = 20.0 * 5.4 * std::sin(0.3 * s) / (400.0 + north_m_s * north_m_s);
    const double speed_m_s = std::hypot(20.0, north_m_s);
    at.angles = {std::atan(speed_m_s * turn_rad_s / 9.80665),
                 std::atan(0.5 / speed_m_s),
                 std::atan2(20.0, north_m_s)};
    at.R_ned_body = logs::R_ned_body_from(at.angles);
    return at;
  }
  [[nodiscard]] const LocalFrame& frame() const { return frame_; }

 private:
  TemporaryFolder folder_;
  LocalFrame frame_{geodetic_from_deg(47.0, 8.0, 0.0)};
};

}  // namespace overfly::flight::testing
