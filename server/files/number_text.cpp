#include "server/files/number_text.hpp"

#include <algorithm>

namespace overfly::server {

std::string number_list(std::initializer_list<double> values, const std::string& separator) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : separator) + number_text(value);
  return text;
}

std::string yaml_number(double value) {
  std::string text = number_text(value);
  if (text.find('.') == std::string::npos) text.insert(std::min(text.find('e'), text.size()), ".0");
  return text;
}

std::string yaml_list(std::span<const double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + yaml_number(value);
  return "[" + text + "]";
}

std::string padded(std::int64_t number, int digits) {
  std::string text = std::to_string(number);
  if (static_cast<int>(text.size()) < digits) text.insert(0, digits - text.size(), '0');
  return text;
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

}  // namespace overfly::server
