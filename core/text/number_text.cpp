#include "core/text/number_text.hpp"

#include <charconv>
#include <cstdio>
#include <system_error>

#include "core/time.hpp"

namespace overfly {

std::string number_text(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, error == std::errc() ? end : buffer};
}

std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string seconds_text(std::int64_t t_ns) {
  // Unsigned, because the magnitude of the smallest int64 does not fit in an int64.
  const auto size =
      t_ns < 0 ? 0 - static_cast<std::uint64_t>(t_ns) : static_cast<std::uint64_t>(t_ns);
  constexpr std::uint64_t kNs = kNsPerS;
  const std::string fraction = std::to_string(size % kNs);
  std::string text = t_ns < 0 ? "-" : "";
  text += std::to_string(size / kNs);
  text += '.';
  text.append(9 - fraction.size(), '0');
  return text += fraction;
}

std::string counted(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace overfly
