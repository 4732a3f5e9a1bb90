#include "server/files/number_text.hpp"

#include <charconv>
#include <system_error>

#include "core/time.hpp"

namespace overfly::engine {

std::string number_text(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, error == std::errc() ? end : buffer};
}

std::string number_list(std::initializer_list<double> values, const std::string& separator) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : separator) + number_text(value);
  return text;
}

std::string padded(std::int64_t number, int digits) {
  std::string text = std::to_string(number);
  if (static_cast<int>(text.size()) < digits) text.insert(0, digits - text.size(), '0');
  return text;
}

std::string seconds_text(std::int64_t t_ns) {
  // Stamps of a camera with a clock offset may be negative.
  const std::int64_t size_ns = t_ns < 0 ? -t_ns : t_ns;
  std::string text = t_ns < 0 ? "-" : "";
  text += std::to_string(size_ns / kNsPerS);
  text += '.';
  return text += padded(size_ns % kNsPerS, 9);
}

std::string matrix_rows(const Pose& pose, int rows, const std::string& separator) {
  const Eigen::Matrix4d T = pose.matrix();
  std::string text;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < 4; ++column) {
      text += (text.empty() ? "" : separator) + number_text(T(row, column));
    }
  }
  return text;
}

}  // namespace overfly::engine
