#include "evaluation/long_steps.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/time.hpp"

namespace overfly::evaluation {
namespace {

constexpr std::int64_t kMedianSteps = 10;

std::int64_t step_ns(const Trajectory& truth, std::size_t i) {
  return truth.poses()[i].t_ns - truth.poses()[i - 1].t_ns;
}

/// Whether both poses of a step are the same as far as a pose can be measured: a truth that is only
/// written when something moves.
bool stands_still(const Trajectory& truth, std::size_t i) {
  constexpr double kStillM = 0.01;
  constexpr double kStillRad = 0.002;
  const Pose& before = truth.poses()[i - 1].pose;
  const Pose& after = truth.poses()[i].pose;
  return (after.translation - before.translation).norm() <= kStillM &&
         rotation_angle_rad(before.rotation, after.rotation) <= kStillRad;
}

std::int64_t limit_of(const Trajectory& truth) {
  std::vector<std::int64_t> steps_ns;
  for (std::size_t i = 1; i < truth.size(); ++i) steps_ns.push_back(step_ns(truth, i));
  if (steps_ns.empty()) return kNsPerS;
  const auto middle = steps_ns.begin() + static_cast<std::ptrdiff_t>(steps_ns.size() / 2);
  std::nth_element(steps_ns.begin(), middle, steps_ns.end());
  // Stamps may be so far apart that a multiple of their step is no time any more.
  if (*middle > INT64_MAX / kMedianSteps) return INT64_MAX;
  return std::max(kNsPerS, kMedianSteps * *middle);
}

}  // namespace

LongSteps long_steps(const Trajectory& truth) {
  LongSteps steps;
  steps.limit_ns = limit_of(truth);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    if (truth.has_gap_before(i) || step_ns(truth, i) <= steps.limit_ns) continue;
    if (stands_still(truth, i)) continue;
    steps.ending.push_back(i);
    steps.longest_ns = std::max(steps.longest_ns, step_ns(truth, i));
  }
  return steps;
}

Trajectory with_gaps_in(const LongSteps& steps, Trajectory truth) {
  for (const std::size_t i : steps.ending) truth.mark_gap_before(i);
  return truth;
}

std::string words_for(const LongSteps& steps) {
  std::array<char, 120> text{};
  std::snprintf(text.data(),
                text.size(),
                "its steps of more than %.3f s are gaps (%zu, the longest %.3f s)",
                s_from_ns(steps.limit_ns),
                steps.ending.size(),
                s_from_ns(steps.longest_ns));
  return text.data();
}

}  // namespace overfly::evaluation
