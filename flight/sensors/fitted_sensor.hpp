// A sensor with its clock, and the samples on their way from it. Private to flight/sensors.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/sensors/sensor_samples.hpp"
#include "core/time.hpp"

namespace overfly::flight {

inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

/// Samples that wait until they are available.
template <typename Sample>
class Outbox {
 public:
  void add(const Sample& sample) { waiting_.push_back(sample); }
  void take_until(std::int64_t t_ns, std::vector<Sample>& samples) {
    while (!waiting_.empty() && available_ns(waiting_.front()) <= t_ns) {
      samples.push_back(waiting_.front());
      waiting_.pop_front();
    }
  }

 private:
  std::deque<Sample> waiting_;
};

/// A sensor that may be absent, with its clock and its outbox.
template <typename Sensor, typename Sample>
struct Fitted {
  std::optional<Sensor> sensor;
  FrameRate rate;
  std::int64_t count = 0;
  Outbox<Sample> outbox;

  template <typename Model, typename... Arguments>
  void fit(const std::optional<Model>& model, Arguments&&... arguments) {
    if (!model) return;
    rate = FrameRate::from_hz(model->rate_hz).value();
    sensor.emplace(*model, std::forward<Arguments>(arguments)...);
  }
  [[nodiscard]] std::int64_t next_ns() const {
    return sensor ? frame_time_ns(count, rate) : kNever;
  }
};

}  // namespace overfly::flight
