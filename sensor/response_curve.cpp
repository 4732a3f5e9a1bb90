#include <algorithm>
#include <cmath>

#include "sensor/sensor_model.hpp"

namespace overfly::sensor {

namespace {

/// IEC 61966-2-1 (sRGB), clause 5.2.
double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}
double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double table_at(const std::vector<double>& table, double input) {
  const double place = input * static_cast<double>(table.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), table.size() - 2);
  const double share = place - static_cast<double>(below);
  return table[below] + share * (table[below + 1] - table[below]);
}

double place_in_table(const std::vector<double>& table, double output) {
  const auto above = std::upper_bound(table.begin() + 1, table.end() - 1, output);
  const auto below = above - 1;
  const double share = (output - *below) / (*above - *below);
  return (static_cast<double>(below - table.begin()) + share) /
         static_cast<double>(table.size() - 1);
}

}  // namespace

const char* to_string(ResponseShape shape) {
  switch (shape) {
    case ResponseShape::kSrgb:
      return "srgb";
    case ResponseShape::kGamma:
      return "gamma";
    case ResponseShape::kTable:
      return "table";
  }
  return "";
}

std::optional<ResponseShape> response_shape_from(const std::string& text) {
  for (const auto shape : {ResponseShape::kSrgb, ResponseShape::kGamma, ResponseShape::kTable}) {
    if (text == to_string(shape)) return shape;
  }
  return std::nullopt;
}

double ResponseCurve::operator()(double input) const {
  const double clamped = std::clamp(input, 0.0, 1.0);
  switch (shape) {
    case ResponseShape::kSrgb:
      return srgb_from_linear(clamped);
    case ResponseShape::kTable:
      return table_at(table, clamped);
    case ResponseShape::kGamma:
      break;
  }
  return gamma == 1.0 ? clamped : std::pow(clamped, 1.0 / gamma);
}

double ResponseCurve::inverse(double output) const {
  const double clamped = std::clamp(output, 0.0, 1.0);
  switch (shape) {
    case ResponseShape::kSrgb:
      return linear_from_srgb(clamped);
    case ResponseShape::kTable:
      return place_in_table(table, clamped);
    case ResponseShape::kGamma:
      break;
  }
  return gamma == 1.0 ? clamped : std::pow(clamped, gamma);
}

}  // namespace overfly::sensor
