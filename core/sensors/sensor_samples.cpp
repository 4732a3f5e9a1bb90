#include "core/sensors/sensor_samples.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace overfly {
namespace {

template <typename Sample>
void append_samples(std::vector<Sample>& to, std::vector<Sample>& from) {
  if (to.empty()) {
    to = std::move(from);
  } else {
    to.insert(to.end(), from.begin(), from.end());
  }
}

template <typename Samples, typename Visit>
void with_each_list(Samples& samples, const Visit& visit) {
  visit(samples.imu);
  visit(samples.barometer);
  visit(samples.gps);
  visit(samples.airspeed);
  visit(samples.magnetometer);
  visit(samples.range);
}

}  // namespace

void append(SensorSamples& to, SensorSamples&& from) {
  append_samples(to.imu, from.imu);
  append_samples(to.barometer, from.barometer);
  append_samples(to.gps, from.gps);
  append_samples(to.airspeed, from.airspeed);
  append_samples(to.magnetometer, from.magnetometer);
  append_samples(to.range, from.range);
}

std::optional<std::int64_t> first_available_ns(const SensorSamples& samples) {
  std::optional<std::int64_t> first_ns;
  with_each_list(samples, [&](const auto& list) {
    if (list.empty()) return;
    const std::int64_t t_ns = available_ns(list.front());
    first_ns = std::min(first_ns.value_or(t_ns), t_ns);
  });
  return first_ns;
}

void drop_available_at(SensorSamples& samples, std::int64_t t_ns) {
  with_each_list(samples, [&](auto& list) {
    const auto kept = std::find_if(
        list.begin(), list.end(), [&](const auto& sample) { return available_ns(sample) > t_ns; });
    list.erase(list.begin(), kept);
  });
}

void drop_older_than(SensorSamples& samples, std::int64_t age_ns) {
  if (samples.empty()) return;
  std::int64_t newest_ns = std::numeric_limits<std::int64_t>::min();
  with_each_list(samples, [&](const auto& list) {
    if (!list.empty()) newest_ns = std::max(newest_ns, available_ns(list.back()));
  });
  drop_available_at(samples, newest_ns - age_ns - 1);
}

}  // namespace overfly
