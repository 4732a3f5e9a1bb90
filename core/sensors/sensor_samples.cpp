#include "core/sensors/sensor_samples.hpp"

#include <algorithm>
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

template <typename Sample>
void drop_samples_before(std::vector<Sample>& samples, std::int64_t t_ns) {
  const auto kept = std::find_if(samples.begin(), samples.end(), [&](const Sample& sample) {
    return sample.t_ns >= t_ns;
  });
  samples.erase(samples.begin(), kept);
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

void drop_before(SensorSamples& samples, std::int64_t t_ns) {
  drop_samples_before(samples.imu, t_ns);
  drop_samples_before(samples.barometer, t_ns);
  drop_samples_before(samples.gps, t_ns);
  drop_samples_before(samples.airspeed, t_ns);
  drop_samples_before(samples.magnetometer, t_ns);
  drop_samples_before(samples.range, t_ns);
}

}  // namespace overfly
