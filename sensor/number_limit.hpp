// The check of a parameter against its limits, for the models of this folder.
#pragma once

#include <initializer_list>
#include <string>

#include "core/result.hpp"

namespace overfly::sensor {

/// A number with its name and closed limits.
struct NumberLimit {
  const char* field;
  double value;
  double low;
  double high;
};

/// Six significant digits, for messages.
[[nodiscard]] std::string rounded_text(double value);

/// Errors: kInvalidArgument naming the first field outside its limits (or not a number).
[[nodiscard]] Status check_limits(std::initializer_list<NumberLimit> limits);

}  // namespace overfly::sensor
