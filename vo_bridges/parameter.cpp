#include "vo_bridges/parameter.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace overfly {

namespace {

/// Numbers between these limits, and 0, are written without an exponent.
constexpr double kSmallestPlain = 1e-9;
constexpr double kLargestPlain =
    9007199254740992.0;  // 2^53: doubles represent every integer up to it

std::string text_of_number(double number) {
  const double size = std::abs(number);
  const bool plain = size == 0.0 || (size >= kSmallestPlain && size <= kLargestPlain);
  std::array<char, 32> text{};
  char* const end = text.data() + text.size();
  const auto written = plain ? std::to_chars(text.data(), end, number, std::chars_format::fixed)
                             : std::to_chars(text.data(), end, number);
  return {text.data(), written.ptr};
}

}  // namespace

std::string text_of(const ParameterValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const double* number = std::get_if<double>(&value)) return text_of_number(*number);
  return std::get<std::string>(value);
}

}  // namespace overfly
