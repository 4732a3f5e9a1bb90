#include "flight/sensors/sensor_suite.hpp"

#include <algorithm>
#include <utility>

#include "core/motion/wrapped_truth.hpp"
#include "core/time.hpp"
#include "flight/sensors/fitted_sensor.hpp"

namespace overfly::flight {
namespace {

/// One seed for each sensor.
std::uint64_t seed_of_sensor(std::uint64_t seed, std::uint64_t index) {
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;
  constexpr std::uint64_t kFirst = 1000;  // behind the seeds of cameras and faults
  return seed + kGolden * (kFirst + index);
}

class SensedFlight final : public WrappedTruth {
 public:
  SensedFlight(std::unique_ptr<TruthSource> flight, SensorSuite& suite)
      : WrappedTruth(std::move(flight)), suite_(suite) {}

 private:
  [[nodiscard]] Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* cancel) override {
    while (suite_.next_ns() <= t_ns) {
      const std::int64_t sample_ns = suite_.next_ns();
      auto state = flight().state_at(sample_ns, cancel);
      if (!state || !*state) return state;
      (*state)->t_ns = sample_ns;
      suite_.take(**state);
    }
    return flight().state_at(t_ns, cancel);
  }

  SensorSuite& suite_;
};

}  // namespace

std::uint64_t imu_seed(std::uint64_t suite_seed) { return seed_of_sensor(suite_seed, 0); }

struct SensorSuite::Sensors {
  explicit Sensors(SensorPlace at) : place(std::move(at)) {}

  SensorPlace place;
  std::optional<Imu> imu;
  Outbox<ImuSample> imu_outbox;
  Fitted<Barometer, BarometerSample> barometer;
  Fitted<Gps, GpsSample> gps;
  Fitted<AirspeedSensor, AirspeedSample> airspeed;
  Fitted<Magnetometer, MagnetometerSample> magnetometer;
  Fitted<RangeFinder, RangeSample> range;
};

SensorSuite::SensorSuite(Options options)
    : sensors_(std::make_unique<Sensors>(std::move(options.place))) {
  const SensorModels& models = options.models;
  Sensors& all = *sensors_;
  const std::uint64_t seed = options.seed;
  if (models.imu) all.imu.emplace(*models.imu, options.gravity_m_s2, imu_seed(seed));
  all.barometer.fit(models.barometer, seed_of_sensor(seed, 1));
  all.gps.fit(models.gps, std::move(options.gps_outages), seed_of_sensor(seed, 2));
  all.airspeed.fit(models.airspeed, seed_of_sensor(seed, 3));
  all.magnetometer.fit(models.magnetometer, seed_of_sensor(seed, 4));
  all.range.fit(models.range, seed_of_sensor(seed, 5));
}
SensorSuite::~SensorSuite() = default;
SensorSuite::SensorSuite(SensorSuite&& other) noexcept = default;
SensorSuite& SensorSuite::operator=(SensorSuite&& other) noexcept = default;

std::int64_t SensorSuite::next_ns() const {
  const Sensors& all = *sensors_;
  return std::min({all.imu ? all.imu->next_ns() : kNever,
                   all.barometer.next_ns(),
                   all.gps.next_ns(),
                   all.airspeed.next_ns(),
                   all.magnetometer.next_ns(),
                   all.range.next_ns()});
}

void SensorSuite::take(const AircraftState& state) {
  Sensors& all = *sensors_;
  if (all.imu && all.imu->next_ns() == state.t_ns) {
    const std::optional<ImuReading> reading = all.imu->take(state);
    if (reading) all.imu_outbox.add(reading->sample);
  }
  const auto measure = [&](auto& fitted, const auto& place) {
    if (fitted.next_ns() != state.t_ns) return;
    ++fitted.count;
    fitted.outbox.add(fitted.sensor->measure(state, place));
  };
  measure(all.barometer, all.place);
  measure(all.gps, all.place);
  measure(all.airspeed, all.place);
  measure(all.magnetometer, all.place);
  measure(all.range, *all.place.ground);
}

SensorSamples SensorSuite::take_until(std::int64_t t_ns) {
  Sensors& all = *sensors_;
  SensorSamples samples;
  all.imu_outbox.take_until(t_ns, samples.imu);
  all.barometer.outbox.take_until(t_ns, samples.barometer);
  all.gps.outbox.take_until(t_ns, samples.gps);
  all.airspeed.outbox.take_until(t_ns, samples.airspeed);
  all.magnetometer.outbox.take_until(t_ns, samples.magnetometer);
  all.range.outbox.take_until(t_ns, samples.range);
  return samples;
}

std::unique_ptr<TruthSource> sensed_while_flown(std::unique_ptr<TruthSource> flight,
                                                SensorSuite& suite) {
  return std::make_unique<SensedFlight>(std::move(flight), suite);
}

}  // namespace overfly::flight
