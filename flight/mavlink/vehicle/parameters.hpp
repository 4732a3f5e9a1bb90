// Parameters of a vehicle.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "flight/mavlink/vehicle/exchange.hpp"

namespace overfly::flight::mavlink {

inline constexpr std::size_t kMaxParameterName = 16;

/// 1 to 16 letters, digits or underscores.
[[nodiscard]] bool is_parameter_name(std::string_view name);

struct Parameter {
  std::string name;
  double value = 0.0;
  std::uint8_t type = 9;  ///< MAV_PARAM_TYPE: 1 to 8 integers of 8 to 64 bits, 9 float
};

/// Reads one parameter. Errors: kInvalidArgument for text that is no name; kNotFound
/// if the vehicle does not answer: autopilots ignore names that they do not have.
[[nodiscard]] Result<Parameter> read_parameter(Exchange& exchange, const std::string& name);

/// Sets a parameter and compares what the vehicle then reports.
/// Errors: as read_parameter; kInvalidArgument if the value does not fit into the parameter's type;
/// kConflict if the vehicle keeps another value.
[[nodiscard]] Status set_parameter(Exchange& exchange, const std::string& name, double value);

/// Reads all parameters, and asks again for those that get lost on the way. Ordered by index.
/// Errors: as ask(); kIo naming the number of parameters that are missing.
[[nodiscard]] Result<std::vector<Parameter>> read_all_parameters(Exchange& exchange);

}  // namespace overfly::flight::mavlink
