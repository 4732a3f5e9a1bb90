// Flights from ROS topics in scenario documents.
#pragma once

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "flight/ros/ros_flight.hpp"

namespace overfly::server {

/// Reads `flight.ros`. @pre it is valid and has its defaults
/// Errors: kInvalidArgument naming the field, its value and its limit.
[[nodiscard]] Result<flight::ros_live::RosFlight> read_ros_flight(const nlohmann::json& ros);

}  // namespace overfly::server
