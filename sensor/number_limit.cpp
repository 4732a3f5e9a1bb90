#include "sensor/number_limit.hpp"

#include <cstdio>

namespace overfly::renderer {

std::string number_text(double value) {
  std::string text(32, '\0');
  const int length = std::snprintf(text.data(), text.size(), "%.6g", value);
  text.resize(static_cast<std::size_t>(length));
  return text;
}

Status check_limits(std::initializer_list<NumberLimit> limits) {
  for (const NumberLimit& limit : limits) {
    if (limit.value >= limit.low && limit.value <= limit.high) continue;
    return Error{ErrorCode::kInvalidArgument,
                 std::string(limit.field) + " = " + number_text(limit.value) + ": must be in [" +
                     number_text(limit.low) + ", " + number_text(limit.high) + "]"};
  }
  return {};
}

}  // namespace overfly::renderer
