// What the records of one format contribute to a flight log. Private to dataflash.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "flight/logs/dataflash/record_format.hpp"
#include "flight/logs/dataflash/sensor_records.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// The fields of a format that a flight needs, found by name once for all its records.
struct RecordPlan {
  RecordFormat format;
  std::optional<RecordField> time;
  std::int64_t ns_per_time_unit = 0;
  StreamDescription description;  ///< its name without the instance

  std::array<RecordField, 3> position;                 ///< if description.position says so
  std::optional<std::array<RecordField, 3>> velocity;  ///< of SIM2: north, east, down [m/s]
  std::optional<std::array<RecordField, 4>> quaternion;
  std::optional<std::array<RecordField, 3>> angles;  ///< roll, pitch, yaw
  std::optional<RecordField> fix;                    ///< of GPS: 3 and above is a fix
  std::optional<EventKind> event;
  SensorPlan sensor;
};

[[nodiscard]] RecordPlan plan_of(const RecordFormat& format);

/// @pre the plan has such fields
[[nodiscard]] Eigen::Vector3d vector_in(const std::array<RecordField, 3>& fields,
                                        std::span<const std::uint8_t> record);
/// R_ned_body of the quaternion or else of the angles. @pre the plan has an attitude
[[nodiscard]] Eigen::Quaterniond attitude_in(const RecordPlan& plan,
                                             std::span<const std::uint8_t> record);
/// The text of an event's record.
/// @param is_ardu_plane  whose modes have names
[[nodiscard]] std::string event_text(const RecordPlan& plan,
                                     std::span<const std::uint8_t> record,
                                     bool is_ardu_plane);

}  // namespace overfly::flight::logs
