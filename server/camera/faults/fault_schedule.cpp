#include "server/camera/faults/fault_schedule.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/time.hpp"

namespace overfly::server {
namespace {

/// A random 64-bit word from a seed and a number: the finaliser of splitmix64 (Steele, Lea, Flood
/// 2014, doi:10.1145/2660193.2660195).
std::uint64_t mixed(std::uint64_t seed, std::uint64_t number) {
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = seed + kGolden * (number + 1);
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31U);
}

/// In (0, 1).
double uniform(std::uint64_t seed, std::uint64_t number) {
  return (static_cast<double>(mixed(seed, number) >> 11U) + 0.5) * 0x1p-53;
}

/// A standard normal variable (Box and Muller 1958).
double normal(std::uint64_t seed, std::int64_t frame) {
  const auto number = 2 * static_cast<std::uint64_t>(frame);
  return std::sqrt(-2.0 * std::log(uniform(seed, number))) *
         std::cos(2.0 * kPi * uniform(seed, number + 1));
}

std::string duration_text(std::int64_t duration_ns) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g s", s_from_ns(duration_ns));
  return text.data();
}

std::string camera_text(const Scenario& scenario, const FaultSpec& fault) {
  if (fault.kind == FaultKind::kGpsOutage) return "";
  if (fault.camera) return " of " + scenario.cameras[*fault.camera].name;
  return scenario.cameras.size() > 1 ? " of all cameras" : "";
}

}  // namespace

FaultSchedule::FaultSchedule(const Scenario& scenario)
    : scenario_(scenario), last_stamp_ns_(scenario.cameras.size()) {}

FrameFaults FaultSchedule::at(std::size_t camera, std::int64_t frame, std::int64_t t_ns) {
  FrameFaults result;
  result.stamp_ns = t_ns;
  for (const FaultSpec& fault : scenario_.faults) {
    if (!fault.in_force(camera, t_ns) || fault.kind == FaultKind::kGpsOutage) continue;
    if (fault.on_lens()) {
      result.on_lens.push_back(&fault);
    } else if (fault.kind == FaultKind::kDroppedFrames) {
      if (!drops(fault, frame)) continue;
      result.dropped = true;
    } else if (fault.kind == FaultKind::kFrozenFrame) {
      result.frozen = true;
    } else if (fault.kind == FaultKind::kStampOffset) {
      result.stamp_ns += fault.offset_ns;
    } else if (fault.kind == FaultKind::kStampJitter) {
      result.stamp_ns += std::llround(fault.sigma_ns * normal(fault.seed, frame));
    }
    const std::string name = to_string(fault.kind);
    if (std::find(result.names.begin(), result.names.end(), name) == result.names.end()) {
      result.names.push_back(name);
    }
  }
  constexpr std::int64_t kSmallestStepNs = 1000;
  std::optional<std::int64_t>& last_ns = last_stamp_ns_.at(camera);
  if (last_ns && result.stamp_ns <= *last_ns) result.stamp_ns = *last_ns + kSmallestStepNs;
  last_ns = result.stamp_ns;
  return result;
}

bool FaultSchedule::drops(const FaultSpec& fault, std::int64_t frame) const {
  if (fault.probability) {
    return uniform(fault.seed, static_cast<std::uint64_t>(frame)) < *fault.probability;
  }
  // The first frame stamped at or after the fault's start.
  auto first = static_cast<std::int64_t>(s_from_ns(fault.at_ns) * scenario_.rate.hz());
  while (first > 0 && frame_time_ns(first - 1, scenario_.rate) >= fault.at_ns) --first;
  while (frame_time_ns(first, scenario_.rate) < fault.at_ns) ++first;
  return (frame - first) % fault.every == 0;
}

bool FaultSchedule::may_freeze(std::size_t camera) const {
  return std::any_of(
      scenario_.faults.begin(), scenario_.faults.end(), [camera](const FaultSpec& fault) {
        return fault.kind == FaultKind::kFrozenFrame && fault.camera.value_or(camera) == camera;
      });
}

std::vector<FaultNews::Line> FaultNews::at(std::int64_t t_ns) {
  std::vector<Line> lines;
  for (std::size_t i = 0; i < scenario_.faults.size(); ++i) {
    const FaultSpec& fault = scenario_.faults[i];
    const bool now = fault.in_force(fault.camera.value_or(0), t_ns);
    if (now == in_force_[i]) continue;
    in_force_[i] = now;
    std::string text = std::string(to_string(fault.kind)) + camera_text(scenario_, fault);
    text += now ? " begins" : " ends";
    const bool ends = fault.end_ns != FaultSpec().end_ns;
    if (now) text += ends ? ", for " + duration_text(fault.end_ns - fault.at_ns) : ", to the end";
    lines.push_back({now, std::move(text)});
  }
  return lines;
}

}  // namespace overfly::server
