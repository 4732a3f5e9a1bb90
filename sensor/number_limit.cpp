#include "sensor/number_limit.hpp"

#include <cstdio>

namespace overfly::sensor {

std::string rounded_text(double value) {
  std::string text(32, '\0');
  const int length = std::snprintf(text.data(), text.size(), "%.6g", value);
  text.resize(static_cast<std::size_t>(length));
  return text;
}

Status check_limits(std::initializer_list<NumberLimit> limits) {
  for (const NumberLimit& limit : limits) {
    if (limit.value >= limit.low && limit.value <= limit.high) continue;
    return Error{ErrorCode::kInvalidArgument,
                 std::string(limit.field) + " = " + rounded_text(limit.value) + ": must be in [" +
                     rounded_text(limit.low) + ", " + rounded_text(limit.high) + "]"};
  }
  return {};
}

}  // namespace overfly::sensor
