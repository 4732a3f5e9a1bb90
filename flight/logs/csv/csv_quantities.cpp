#include "flight/logs/csv/csv_quantities.hpp"

#include <array>

#include "core/motion/pose.hpp"

namespace overfly::flight::logs {
namespace {

constexpr std::array<QuantityFacts, kCsvQuantities> kQuantities{
    {{"lat", Dimension::kDegrees},
     {"lon", Dimension::kDegrees},
     {"alt_msl", Dimension::kLength},
     {"roll", Dimension::kRadians},
     {"pitch", Dimension::kRadians},
     {"yaw", Dimension::kRadians},
     {"qw", Dimension::kNumber},
     {"qx", Dimension::kNumber},
     {"qy", Dimension::kNumber},
     {"qz", Dimension::kNumber},
     {"rate_x", Dimension::kRate},
     {"rate_y", Dimension::kRate},
     {"rate_z", Dimension::kRate},
     {"force_x", Dimension::kAcceleration},
     {"force_y", Dimension::kAcceleration},
     {"force_z", Dimension::kAcceleration},
     {"field_x", Dimension::kField},
     {"field_y", Dimension::kField},
     {"field_z", Dimension::kField},
     {"pressure", Dimension::kPressure},
     {"airspeed", Dimension::kSpeed},
     {"range", Dimension::kLength}}};

constexpr QuantityGroup kGroups[] = {{0, 3, "lat, lon, alt_msl"},
                                     {3, 3, "roll, pitch, yaw"},
                                     {6, 4, "qw, qx, qy, qz"},
                                     {10, 6, "rate_x, rate_y, rate_z, force_x, force_y, force_z"},
                                     {16, 3, "field_x, field_y, field_z"}};

constexpr Unit kAngleUnits[] = {
    {"deg", 1.0}, {"rad", 180.0 / kPi}, {"cdeg", 0.01}, {"1e-7deg", 1e-7}};
constexpr Unit kLengthUnits[] = {{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"ft", 0.3048}};
constexpr Unit kRateUnits[] = {{"rad/s", 1.0}, {"deg/s", kPi / 180.0}};
constexpr Unit kAccelerationUnits[] = {{"m/s^2", 1.0}, {"g", 9.80665}};
constexpr Unit kFieldUnits[] = {{"uT", 1.0}, {"gauss", 100.0}, {"mgauss", 0.1}};
constexpr Unit kPressureUnits[] = {{"Pa", 1.0}, {"hPa", 100.0}};
constexpr Unit kSpeedUnits[] = {{"m/s", 1.0}, {"km/h", 1.0 / 3.6}, {"kn", 1852.0 / 3600.0}};

}  // namespace

const char* to_string(CsvQuantity quantity) {
  return facts_of(static_cast<std::size_t>(quantity)).name;
}

const QuantityFacts& facts_of(std::size_t quantity) { return kQuantities[quantity]; }

std::span<const QuantityGroup> quantity_groups() { return kGroups; }

std::span<const Unit> units_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::kLength:
      return kLengthUnits;
    case Dimension::kRate:
      return kRateUnits;
    case Dimension::kAcceleration:
      return kAccelerationUnits;
    case Dimension::kField:
      return kFieldUnits;
    case Dimension::kPressure:
      return kPressureUnits;
    case Dimension::kSpeed:
      return kSpeedUnits;
    case Dimension::kDegrees:
    case Dimension::kRadians:
      return kAngleUnits;
    case Dimension::kNumber:
      break;
  }
  return {};
}

}  // namespace overfly::flight::logs
