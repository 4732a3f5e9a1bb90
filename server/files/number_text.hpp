// Numbers as the files of data sets write them.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

#include "core/pose.hpp"

namespace overfly::engine {

/// The shortest decimal that reads back as the same double.
[[nodiscard]] std::string number_text(double value);
/// Numbers between separators.
[[nodiscard]] std::string number_list(std::initializer_list<double> values,
                                      const std::string& separator);
/// Seconds with nine decimals, exact.
[[nodiscard]] std::string seconds_text(std::int64_t t_ns);
/// Digits with leading zeros.
[[nodiscard]] std::string padded(std::int64_t number, int digits);
/// The first three rows of a pose's matrix, row-major, between separators.
[[nodiscard]] std::string matrix_rows(const Pose& pose, int rows, const std::string& separator);

}  // namespace overfly::engine
