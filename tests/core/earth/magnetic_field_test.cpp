// The earth's magnetic field against the published test values of its model.
#include "core/earth/magnetic_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/motion/pose.hpp"
#include "core/time.hpp"

namespace overfly {
namespace {

constexpr std::int64_t kStartOf2025S = 1'735'689'600;

struct TestValue {
  double year, alt_km, lat_deg, lon_deg;
  double north_nt, east_nt, down_nt;
};

// NOAA NCEI, WMM2025_TEST_VALUES.txt (technical report of the model, table 6): rounded to 0.1 nT.
constexpr TestValue kPublished[] = {{2025.0, 0, 80, 0, 6521.6, 145.9, 54791.5},
                                    {2025.0, 0, 0, 120, 39677.8, -109.6, -10580.2},
                                    {2025.0, 0, -80, 240, 6117.5, 15751.9, -52022.5},
                                    {2025.0, 100, 80, 0, 6216.0, 92.4, 52598.8},
                                    {2025.0, 100, 0, 120, 37688.6, -96.2, -10152.1},
                                    {2025.0, 100, -80, 240, 5907.6, 14780.3, -49540.7},
                                    {2027.5, 0, 80, 0, 6500.8, 294.5, 54869.4},
                                    {2027.5, 0, 0, 120, 39701.6, -167.4, -10381.8},
                                    {2027.5, 0, -80, 240, 6200.7, 15730.3, -51783.7},
                                    {2027.5, 100, 80, 0, 6196.7, 233.8, 52670.5},
                                    {2027.5, 100, 0, 120, 37711.5, -148.7, -9969.8},
                                    {2027.5, 100, -80, 240, 5984.0, 14760.1, -49317.7}};

std::int64_t unix_ns_of(double year) {
  return (kStartOf2025S + std::llround((year - 2025.0) * 365.25 * 86400.0)) * kNsPerS;
}

TEST(MagneticField, HasThePublishedTestValues) {
  for (const TestValue& value : kPublished) {
    const MagneticField field(unix_ns_of(value.year));
    const Eigen::Vector3d ned_ut =
        field.ned_ut(geodetic_from_deg(value.lat_deg, value.lon_deg, 1e3 * value.alt_km));
    const Eigen::Vector3d published_nt(value.north_nt, value.east_nt, value.down_nt);
    EXPECT_LT((1e3 * ned_ut - published_nt).cwiseAbs().maxCoeff(), 0.051)
        << value.year << " " << value.lat_deg << ": " << (1e3 * ned_ut).transpose();
  }
}

TEST(MagneticField, StaysAtTheEndsOfItsYears) {
  const Geodetic place = geodetic_from_deg(39.3, -86.0, 300.0);
  const Eigen::Vector3d first = MagneticField(unix_ns_of(2025.0)).ned_ut(place);
  const Eigen::Vector3d last = MagneticField(unix_ns_of(2030.0)).ned_ut(place);
  EXPECT_EQ(MagneticField(0).ned_ut(place), first);
  EXPECT_EQ(MagneticField(unix_ns_of(2100.0)).ned_ut(place), last);
  EXPECT_GT((last - first).norm(), 0.1);
}

}  // namespace
}  // namespace overfly
