// Makes scenarios/autzen_tour.csv, and checks that the file is what it makes: a tour of 60 s at
// 22 m/s, 200 m above the ground model of the Autzen photograph. To write the file again:
//   OVERFLY_UPDATE_AUTZEN_TOUR=1 flight_tests --gtest_filter='AutzenTour.*'
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>

#include "core/time.hpp"
#include "flight/flight.hpp"
#include "flight/ground_track.hpp"
#include "flight/height_profile.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight {
namespace {

using overfly::testing::read_text;
using overfly::testing::source_file;

constexpr double kTourSpeedMS = 22.0;
constexpr double kTourDurationS = 60.0;
constexpr double kHeightAglM = 200.0;
constexpr double kRatePerS = 50.0;
/// Knots of the height: long, since the stadium's walls are in the ground model, and no aircraft
/// at 200 m would bob over them.
constexpr double kKnotM = 120.0;
/// Height of the geoid above WGS84 at the photograph: the ground model is in NAVD88.
constexpr double kGeoidSeparationM = -22.6;
/// Middle of the photograph, EPSG:26910.
constexpr double kMiddleX = 494476.88;
constexpr double kMiddleY = 4878110.69;

/// The ground model, bilinear between the centres of its cells.
class GroundModel {
 public:
  explicit GroundModel(const std::string& file) {
    GDALAllRegister();
    data_.reset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    if (!data_) return;
    data_->GetGeoTransform(transform_.data());
    heights_.resize(static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()));
    if (data_->GetRasterBand(1)->RasterIO(GF_Read,
                                          0,
                                          0,
                                          width(),
                                          height(),
                                          heights_.data(),
                                          width(),
                                          height(),
                                          GDT_Float32,
                                          0,
                                          0) != CE_None) {
      heights_.clear();
    }
    OGRSpatialReference geographic;
    geographic.importFromEPSG(4269);  // NAD83, taken for WGS84: a metre at most
    geographic.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    OGRSpatialReference projected;
    projected.importFromEPSG(26910);
    projected.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    to_map_.reset(OGRCreateCoordinateTransformation(&geographic, &projected));
    from_map_.reset(OGRCreateCoordinateTransformation(&projected, &geographic));
  }
  [[nodiscard]] bool open() const { return data_ && !heights_.empty() && to_map_ && from_map_; }

  [[nodiscard]] Geodetic middle() {
    double x = kMiddleX;
    double y = kMiddleY;
    from_map_->Transform(1, &x, &y);
    return geodetic_from_deg(y, x, height_m(kMiddleX, kMiddleY) + kGeoidSeparationM);
  }
  /// Ellipsoidal height of the ground.
  [[nodiscard]] double alt_ellipsoid_m(const Geodetic& point) {
    double x = deg_from_rad(point.lon_rad);
    double y = deg_from_rad(point.lat_rad);
    to_map_->Transform(1, &x, &y);
    return height_m(x, y) + kGeoidSeparationM;
  }

 private:
  [[nodiscard]] int width() const { return data_->GetRasterXSize(); }
  [[nodiscard]] int height() const { return data_->GetRasterYSize(); }
  [[nodiscard]] double cell(int col, int row) const {
    const float value = heights_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width()) +
                                 static_cast<std::size_t>(col)];
    return value < -1000.0F ? NAN : static_cast<double>(value);
  }
  [[nodiscard]] double height_m(double x, double y) const {
    const double u = (x - transform_[0]) / transform_[1] - 0.5;
    const double v = (y - transform_[3]) / transform_[5] - 0.5;
    const int col = static_cast<int>(std::floor(u));
    const int row = static_cast<int>(std::floor(v));
    if (col < 0 || row < 0 || col + 1 >= width() || row + 1 >= height()) return NAN;
    const double a = u - col;
    const double b = v - row;
    return (1 - b) * ((1 - a) * cell(col, row) + a * cell(col + 1, row)) +
           b * ((1 - a) * cell(col, row + 1) + a * cell(col + 1, row + 1));
  }

  std::unique_ptr<GDALDataset> data_;
  std::array<double, 6> transform_{};
  std::vector<float> heights_;
  std::unique_ptr<OGRCoordinateTransformation> to_map_;
  std::unique_ptr<OGRCoordinateTransformation> from_map_;
};

/// South along the east side, right about, an S to the left on the way north, right about again.
BankProfile tour() {
  constexpr double kRollRate = rad_from_deg(25.0);
  constexpr double kTurnBank = rad_from_deg(24.0);
  constexpr double kJinkBank = rad_from_deg(20.0);
  BankProfile bank(kRollRate);
  const auto about = [&bank] {
    bank.roll_to(kTurnBank);
    bank.hold(14.40);  // 180 deg in all, with rolling in and out
    bank.roll_to(0.0);
  };
  bank.hold(10.0);
  about();
  bank.hold(1.5);
  bank.roll_to(-kJinkBank);
  bank.hold(1.5);
  bank.roll_to(kJinkBank);
  bank.hold(1.5);
  bank.roll_to(0.0);
  bank.hold(1.0);
  about();
  return bank;
}

std::string make_csv(GroundModel& model) {
  const LocalFrame frame(model.middle());
  // The start that puts the middle of the tour over the middle of the photograph.
  const GroundTrack track(tour(), kTourSpeedMS, {135.0, 112.0, kPi, 0.0}, kTourDurationS);
  const auto ground_up_m = [&](double t_s) {
    const GroundSample at = track.at(t_s);
    Geodetic point = frame.geodetic_from_world({at.east_m, at.north_m, 0.0});
    point.alt_ellipsoid_m = model.alt_ellipsoid_m(point);
    return frame.world_from_geodetic(point).z();
  };
  const HeightProfile height =
      HeightProfile::above(
          ground_up_m,
          kHeightAglM,
          kTourDurationS,
          {.knot_s = kKnotM / kTourSpeedMS, .climb_max_m_s = kTourSpeedMS * std::tan(kClimbMaxRad)})
          .value();
  std::string csv = "t_s,lat_deg,lon_deg,alt_ellipsoid_m,roll_deg,pitch_deg,yaw_deg\n";
  for (int i = 0; i <= static_cast<int>(kTourDurationS * kRatePerS); ++i) {
    const double t_s = i / kRatePerS;
    const GroundSample at = track.at(t_s);
    const HeightSample up = height.at(t_s);
    const Geodetic point = frame.geodetic_from_world({at.east_m, at.north_m, up.up_m});
    const Eigen::Quaterniond R_world_body = R_world_body_from(
        {track.bank_at(t_s).bank_rad, std::atan2(up.climb_m_s, kTourSpeedMS), at.heading_rad});
    const RollPitchYaw attitude =
        attitude_from(frame.R_world_enu_at(point).conjugate() * R_world_body);
    char row[160];
    std::snprintf(row,
                  sizeof row,
                  "%.2f,%.10f,%.10f,%.4f,%.6f,%.6f,%.6f\n",
                  t_s,
                  deg_from_rad(point.lat_rad),
                  deg_from_rad(point.lon_rad),
                  point.alt_ellipsoid_m,
                  deg_from_rad(attitude.roll_rad),
                  deg_from_rad(attitude.pitch_rad),
                  deg_from_rad(attitude.yaw_rad));
    csv += row;
  }
  return csv;
}

TEST(AutzenTour, IsTheFileThatThisTestMakes) {
  OVERFLY_DATA_OR_SKIP(elevation, "terrain/autzen/dtm_3m_utm10.tif");
  GroundModel model(elevation.string());
  ASSERT_TRUE(model.open());
  const std::string made = make_csv(model);
  const auto file = source_file("scenarios/autzen_tour.csv");
  if (std::getenv("OVERFLY_UPDATE_AUTZEN_TOUR") != nullptr)
    overfly::testing::write_text(file, made);
  std::istringstream made_rows(made);
  std::istringstream kept_rows(read_text(file));
  std::string made_row;
  std::string kept_row;
  std::getline(made_rows, made_row);
  std::getline(kept_rows, kept_row);
  EXPECT_EQ(made_row, kept_row);
  int rows = 0;
  while (std::getline(made_rows, made_row) && std::getline(kept_rows, kept_row)) {
    std::array<double, 7> a{};
    std::array<double, 7> b{};
    const char* const format = "%lf,%lf,%lf,%lf,%lf,%lf,%lf";
    std::sscanf(made_row.c_str(), format, &a[0], &a[1], &a[2], &a[3], &a[4], &a[5], &a[6]);
    std::sscanf(kept_row.c_str(), format, &b[0], &b[1], &b[2], &b[3], &b[4], &b[5], &b[6]);
    // Another PROJ may differ in the last digits: a millimetre, 1e-8 deg, 1e-5 deg of attitude.
    const std::array<double, 7> tolerance{0.0, 1e-8, 1e-8, 1e-3, 1e-5, 1e-5, 1e-5};
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance[i]) << kept_row;
    ++rows;
  }
  EXPECT_EQ(rows, 3001);
}

TEST(AutzenTour, FliesSmoothlyAtItsHeightInsideThePhotograph) {
  OVERFLY_DATA_OR_SKIP(elevation, "terrain/autzen/dtm_3m_utm10.tif");
  GroundModel model(elevation.string());
  ASSERT_TRUE(model.open());
  const LocalFrame frame(model.middle());
  const auto flight = fly_log(source_file("scenarios/autzen_tour.csv"), frame);
  ASSERT_TRUE(flight.ok()) << flight.error().message;
  EXPECT_EQ((*flight)->duration_ns(), 60 * kNsPerS);
  for (std::int64_t t_ns = 0; t_ns <= 60 * kNsPerS; t_ns += 7'000'000) {
    const AircraftState state = (*flight)->state_at(t_ns).value().value();
    const Eigen::Vector3d p = state.T_world_body.translation;
    // 183 m of half a footprint are left to each side of the 1030 m x 1366 m photograph.
    ASSERT_LT(std::abs(p.x()), 515.0 - 183.0);
    ASSERT_LT(std::abs(p.y()), 683.0 - 183.0);
    const Geodetic point = frame.geodetic_from_world(p);
    ASSERT_NEAR(point.alt_ellipsoid_m - model.alt_ellipsoid_m(point), kHeightAglM, 12.0);
    ASSERT_NEAR(state.airspeed_m_s, kTourSpeedMS, 0.1);
    // Coordinated: the heading turns at g tan(roll) / V. SLERP holds its rate over 20 ms.
    const RollPitchYaw a = attitude_from(state.T_world_body.rotation);
    const Eigen::Vector3d& omega = state.omega_body_rad_s;
    const double heading_rate =
        (omega.y() * std::sin(a.roll_rad) + omega.z() * std::cos(a.roll_rad)) /
        std::cos(a.pitch_rad);
    ASSERT_NEAR(heading_rate, turn_rate_rad_s(a.roll_rad, kTourSpeedMS), 0.004);
  }
}

}  // namespace
}  // namespace overfly::flight
