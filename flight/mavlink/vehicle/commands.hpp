// Commands to a vehicle, each confirmed by the vehicle.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>

#include "flight/mavlink/vehicle/exchange.hpp"

namespace overfly::flight::mavlink {

/// COMMAND_LONG: a number of MAV_CMD with its seven parameters.
struct Command {
  std::string what;  ///< in messages: "arming"
  std::uint16_t id = 0;
  std::array<float, 7> parameters{};
};

/// MAV_RESULT as text: "unsupported".
[[nodiscard]] std::string result_text(std::uint8_t result);

/// Sends a command until the component that it is for acknowledges it. While the vehicle reports
/// progress, the command is waited for up to a minute. After more than one attempt, the answers to
/// the others are waited for as long as all attempts may take: a late one would answer the next
/// command with the same number. For the same reason messages that came before are dropped.
/// @return the MAV_RESULT; 0: accepted
/// Errors: as ask().
[[nodiscard]] Result<std::uint8_t> command_result(Exchange& exchange,
                                                  const Command& command,
                                                  const Patience& patience = {});

/// As command_result. Errors also: kConflict if the vehicle refuses, with its texts of that time.
[[nodiscard]] Status run_command(Exchange& exchange, const Command& command);

/// Arms the vehicle. A refusal is tried again after 1 s until `limit`, because autopilots refuse
/// until their estimator has settled. Confirmed by a heartbeat.
/// Errors: as run_command.
[[nodiscard]] Status arm(Exchange& exchange, std::chrono::seconds limit);
/// Errors: as run_command.
[[nodiscard]] Status disarm(Exchange& exchange);
/// Changes the mode (its number, e.g. 10 AUTO of ArduPlane). Confirmed by a heartbeat.
/// Errors: as run_command; kIo if no heartbeat has the mode within 5 s.
[[nodiscard]] Status change_mode(Exchange& exchange, std::uint32_t mode);
/// Starts the mission at its first item. Errors: as run_command.
[[nodiscard]] Status start_mission(Exchange& exchange);
/// Takes off and climbs to a height above the place of the start. ArduPlane accepts it for aircraft
/// that take off vertically; others take off by a mission. Errors: as run_command.
[[nodiscard]] Status take_off(Exchange& exchange, double height_m);

}  // namespace overfly::flight::mavlink
