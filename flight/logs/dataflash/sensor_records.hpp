// Samples of sensors in DataFlash records. Private to dataflash.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/sensors/sensor_samples.hpp"
#include "flight/logs/dataflash/record_format.hpp"

namespace overfly::flight::logs {

enum class SensorRecord { kNone, kImu, kBarometer, kGps, kAirspeed, kMagnetometer, kRange };

/// The fields of a format with samples of a sensor, found by name once for all its records.
struct SensorPlan {
  SensorRecord kind = SensorRecord::kNone;
  int rank = 0;  ///< IMU before IMU2 before IMU3
  std::array<RecordField, 6> fields;
  /// Fields that not every version has.
  std::optional<RecordField> first_extra;
  std::optional<RecordField> second_extra;
};

/// IMU, BARO, GPS, ARSP, MAG and RFND, with their numbered kin of old logs (IMU2, BAR2, GPS2,
/// MAG2).
[[nodiscard]] SensorPlan sensor_plan_of(const RecordFormat& format);

/// The sample of a record, in SI units and body axes; heights above mean sea level. RFND counts if
/// it looks down. Accuracies of the GPS are in other records: they are NaN here. Left out: values
/// that are not finite, and what the record marks as not measured.
/// @pre the plan is not kNone
[[nodiscard]] SensorSamples samples_in(const SensorPlan& plan,
                                       std::span<const std::uint8_t> record,
                                       std::int64_t t_ns);

}  // namespace overfly::flight::logs
