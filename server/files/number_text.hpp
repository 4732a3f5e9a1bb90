// Lists, padding and matrices of numbers for data set files.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>

#include "core/motion/pose.hpp"
#include "core/text/number_text.hpp"

namespace overfly::server {

/// Numbers as of number_text, joined by a separator.
[[nodiscard]] std::string number_list(std::initializer_list<double> values,
                                      const std::string& separator);
/// As number_text, but with a point: YAML 1.1 (PyYAML, which ROS and Kalibr use) reads 1e-05 as
/// text, and ORB-SLAM3 rejects 700 as an integer.
[[nodiscard]] std::string yaml_number(double value);
/// "[1.0, 2.5e-05]"
[[nodiscard]] std::string yaml_list(std::span<const double> values);
/// The number in decimal, padded with leading zeros.
[[nodiscard]] std::string padded(std::int64_t number, int digits);
/// The first `rows` rows of a pose's matrix, row-major, joined by a separator.
[[nodiscard]] std::string matrix_rows(const Pose& pose, int rows, const std::string& separator);

}  // namespace overfly::server
