// Number formatting for data set files.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

#include "core/pose.hpp"

namespace overfly::engine {

/// The shortest decimal that parses to the same double.
[[nodiscard]] std::string number_text(double value);
/// Numbers joined by a separator.
[[nodiscard]] std::string number_list(std::initializer_list<double> values,
                                      const std::string& separator);
/// Seconds with nine decimals, exact.
[[nodiscard]] std::string seconds_text(std::int64_t t_ns);
/// The number in decimal, padded with leading zeros.
[[nodiscard]] std::string padded(std::int64_t number, int digits);
/// The first `rows` rows of a pose's matrix, row-major, joined by a separator.
[[nodiscard]] std::string matrix_rows(const Pose& pose, int rows, const std::string& separator);

}  // namespace overfly::engine
