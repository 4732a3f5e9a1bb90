#include "core/sensors/sensor_samples.hpp"

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

}  // namespace overfly
