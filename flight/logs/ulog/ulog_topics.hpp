// What each PX4 topic contributes to a flight log. Private to ulog.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "flight/logs/log_sink.hpp"
#include "flight/logs/ulog/ulog_format.hpp"
#include "flight/logs/ulog/ulog_sensors.hpp"

namespace overfly::flight::logs {

/// The fields of a topic that a flight needs, found once for all its messages.
struct TopicPlan {
  StreamDescription description;
  std::optional<UlogField> time;      ///< [us] since the start
  std::optional<UlogField> sampled;   ///< timestamp_sample of positions and attitudes [us]
  std::array<UlogField, 3> position;  ///< if description.position says so
  std::array<double, 3> position_scale{1.0, 1.0, 1.0};
  std::optional<UlogField> quaternion;             ///< w, x, y, z
  std::optional<UlogField> fix;                    ///< of GPS: 3 and above is a fix
  std::array<std::optional<UlogField>, 2> valid;   ///< flags that must be true
  std::array<std::optional<UlogField>, 3> origin;  ///< ref_lat, ref_lon, ref_alt
  std::array<std::optional<UlogField>, 2> origin_valid;
  std::optional<UlogField> mode;    ///< of vehicle_status
  std::optional<UlogField> arming;  ///< of vehicle_status: 2 is armed
  SensorTopicPlan sensor;
};

/// @param instance  multi_id of the subscription
[[nodiscard]] TopicPlan plan_of(const UlogFormats& formats,
                                const std::string& topic,
                                std::uint8_t instance);

/// The origin of local positions, if a message states it.
[[nodiscard]] std::optional<LocalOrigin> origin_in(const TopicPlan& plan,
                                                   std::span<const std::uint8_t> data);

/// Passes the position and attitude of a message on.
void pass_samples(const TopicPlan& plan,
                  std::span<const std::uint8_t> data,
                  StreamId id,
                  const LogTime& time,
                  LogSink& sink);

}  // namespace overfly::flight::logs
