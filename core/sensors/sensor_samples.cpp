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

}  // namespace

void append(SensorSamples& to, SensorSamples&& from) {
  append_samples(to.imu, from.imu);
  append_samples(to.barometer, from.barometer);
  append_samples(to.gps, from.gps);
  append_samples(to.airspeed, from.airspeed);
  append_samples(to.magnetometer, from.magnetometer);
  append_samples(to.range, from.range);
}

void drop_older_than(SensorSamples& samples, std::int64_t age_ns) {
  std::int64_t newest_ns = std::numeric_limits<std::int64_t>::min();
  const auto see = [&](const auto& list) {
    if (!list.empty()) newest_ns = std::max(newest_ns, list.back().t_ns);
  };
  const auto drop = [&](auto& list) {
    const auto kept = std::find_if(list.begin(), list.end(), [&](const auto& sample) {
      return sample.t_ns >= newest_ns - age_ns;
    });
    list.erase(list.begin(), kept);
  };
  const auto with_each = [&](const auto& visit) {
    visit(samples.imu);
    visit(samples.barometer);
    visit(samples.gps);
    visit(samples.airspeed);
    visit(samples.magnetometer);
    visit(samples.range);
  };
  if (samples.empty()) return;
  with_each(see);
  with_each(drop);
}

}  // namespace overfly
