// What the columns of a mapping hold: names, units, and which go together.
#pragma once

#include <cstddef>
#include <span>

namespace overfly::flight::logs {

/// What a column can hold. Angles of attitudes: body (forward-right-down) relative to
/// north-east-down, intrinsic Z-Y-X; quaternions R_ned_body. Rates, specific forces and fields have
/// body axes.
enum class CsvQuantity {
  kLat,
  kLon,
  kAltMsl,
  kRoll,
  kPitch,
  kYaw,
  kQw,
  kQx,
  kQy,
  kQz,
  kRateX,
  kRateY,
  kRateZ,
  kForceX,
  kForceY,
  kForceZ,
  kFieldX,
  kFieldY,
  kFieldZ,
  kPressure,
  kAirspeed,
  kRange,
};
inline constexpr std::size_t kCsvQuantities = 22;
/// The name in a mapping: "lat", "alt_msl", "qw".
[[nodiscard]] const char* to_string(CsvQuantity quantity);

enum class Dimension {
  kDegrees,
  kRadians,
  kLength,
  kNumber,
  kRate,
  kAcceleration,
  kField,
  kPressure,
  kSpeed,
};

struct QuantityFacts {
  const char* name;
  Dimension dimension;
};

/// By CsvQuantity.
[[nodiscard]] const QuantityFacts& facts_of(std::size_t quantity);

/// Quantities that a piece has all of, or none.
struct QuantityGroup {
  std::size_t first;
  std::size_t count;
  const char* names;
};
[[nodiscard]] std::span<const QuantityGroup> quantity_groups();

struct Unit {
  const char* name;
  double factor;  ///< to the unit of CsvColumn, of angles to degrees
};
/// Empty for numbers without a unit.
[[nodiscard]] std::span<const Unit> units_of(Dimension dimension);

}  // namespace overfly::flight::logs
