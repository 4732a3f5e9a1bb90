// Measurements of a satellite navigation receiver.
#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/truth_source.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "flight/normal_noise.hpp"
#include "flight/sensors/drift.hpp"
#include "flight/sensors/sensor_models.hpp"
#include "flight/sensors/sensor_place.hpp"

namespace overfly::flight {

/// A stretch of time [begin_ns, end_ns).
struct TimeSpan {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
};

/// Sampled at its rate. Position errors along north, east and down: slow Gauss-Markov processes and
/// white noise (Beard and McLain 2012, section 7.5). Samples measured during an outage have no fix;
/// the errors of the others are the same with and without outages.
class Gps {
 public:
  Gps(const GpsModel& model, std::vector<TimeSpan> outages, std::uint64_t seed);
  [[nodiscard]] GpsSample measure(const AircraftState& state, const SensorPlace& place);

 private:
  [[nodiscard]] bool has_fix(std::int64_t t_ns) const;

  GpsModel model_;
  std::vector<TimeSpan> outages_;
  NormalNoise noise_;
  Drift north_;
  Drift east_;
  Drift down_;
};

}  // namespace overfly::flight
