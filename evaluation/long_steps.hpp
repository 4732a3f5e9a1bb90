// Steps of a truth that are too long for interpolation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/motion/trajectory.hpp"

namespace overfly::evaluation {

/// Steps between two poses that are longer than the larger of 1 s and ten times the median step,
/// other than gaps: in them the truth is missing, and the aircraft may have turned. A step from a
/// pose to the same one (0.01 m, 0.002 rad) is none of them: the truth stood still.
struct LongSteps {
  std::int64_t limit_ns = 0;
  std::int64_t longest_ns = 0;      ///< 0 if there is none
  std::vector<std::size_t> ending;  ///< indices of the poses that end them
};

[[nodiscard]] LongSteps long_steps(const Trajectory& truth);

/// The truth with a gap in each of these steps.
[[nodiscard]] Trajectory with_gaps_in(const LongSteps& steps, Trajectory truth);

/// "its steps of more than 1.000 s are gaps (2, the longest 5.005 s)", for people.
[[nodiscard]] std::string words_for(const LongSteps& steps);

}  // namespace overfly::evaluation
