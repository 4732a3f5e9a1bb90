// Interface to the sensors that a flight's own aircraft carries.
#pragma once

#include <cstdint>
#include <string>

#include "core/sensors/sensor_samples.hpp"

namespace overfly {

class SampleSource {
 public:
  virtual ~SampleSource() = default;

  /// The samples that became available up to a time of the run and were not taken before.
  /// @param t_ns  must not decrease from call to call
  [[nodiscard]] virtual SensorSamples take_samples(std::int64_t t_ns) = 0;
  /// One line: the sources and rates of the sensors that have given samples, and which have not.
  /// Empty without samples.
  [[nodiscard]] virtual std::string sensor_report() const = 0;
};

}  // namespace overfly
