#include "vo_bridges/parameter.hpp"

#include <array>
#include <charconv>

namespace overfly {

std::string text_of(const ParameterValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const double* number = std::get_if<double>(&value)) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), *number);
    return {text.data(), end.ptr};
  }
  return std::get<std::string>(value);
}

}  // namespace overfly
