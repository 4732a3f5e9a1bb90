#include "server/export/exported_samples.hpp"

#include <limits>
#include <utility>

#include "flight/gravity.hpp"
#include "flight/sensors/imu.hpp"
#include "flight/sensors/sensor_suite.hpp"

namespace overfly::server {
namespace {

constexpr std::int64_t kBeforeFlightNs = std::numeric_limits<std::int64_t>::min();

using Readings = Result<std::vector<flight::ImuReading>>;

Result<std::vector<ImuSample>> recorded_samples(const RecordedRun& run, std::int64_t end_ns) {
  Result<SensorFilesReader> reader = SensorFilesReader::open(run.folder);
  if (!reader) return reader.error();
  Result<SensorSamples> samples = reader->until(end_ns);
  if (!samples) return samples.error();
  return std::move(samples->imu);
}

/// Those of the IMU of a live vehicle or of a log; empty if the run recorded none.
Readings vehicle_readings(const RecordedRun& run, std::int64_t end_ns, DatasetPlan& plan) {
  const Result<std::vector<ImuSample>> samples = recorded_samples(run, end_ns);
  if (!samples) return samples.error();
  std::vector<flight::ImuReading> readings;
  for (const ImuSample& sample : *samples) readings.push_back({.sample = sample});
  if (readings.size() < 2) return std::vector<flight::ImuReading>();
  plan.imu_of_vehicle = true;
  const std::int64_t length_ns = samples->back().t_ns - samples->front().t_ns;
  plan.imu_model.rate_hz = static_cast<double>(samples->size() - 1) / s_from_ns(length_ns);
  return readings;
}

/// Empty if the run recorded none.
Readings recorded_readings(const RecordedRun& run,
                           const flight::ImuModel& model,
                           std::uint64_t seed,
                           std::int64_t end_ns) {
  const Result<std::vector<ImuSample>> samples = recorded_samples(run, end_ns);
  if (!samples) return samples.error();
  Readings readings = flight::with_biases(*samples, model, flight::imu_seed(seed));
  if (!readings) return readings.error().in((sensors_folder(run.folder) / "imu.csv").string());
  return readings;
}

/// Where the flight begins, for gravity; empty for a flight without states.
Result<std::optional<Geodetic>> place_at_start(const ExportSource& source,
                                               const terrain::World& world) {
  auto flight = open_truth(source, world);
  if (!flight) return flight.error();
  const auto start = (*flight)->state_at(0);
  if (!start) return start.error();
  if (!*start) return std::optional<Geodetic>();
  return std::optional(
      world.tiles->frame().geodetic_from_world((*start)->T_world_body.translation));
}

/// Sets the plan's gravity to the one at the flight's begin, unless the IMU is fitted.
Readings synthesized_readings(const ExportSource& source,
                              const terrain::World& world,
                              std::int64_t end_ns,
                              const std::function<bool()>& keep_going,
                              DatasetPlan& plan) {
  const auto start = place_at_start(source, world);
  if (!start) return start.error();
  if (!*start) return std::vector<flight::ImuReading>();
  auto flight = open_truth(source, world);
  if (!flight) return flight.error();
  // A fitted IMU measures what it measures in a run.
  const bool fitted = source.scenario.sensors.imu.has_value();
  const std::uint64_t seed = source.scenario.seed;
  if (!fitted) plan.gravity_m_s2 = flight::normal_gravity_m_s2(**start);
  return flight::synthesize_imu(**flight,
                                end_ns,
                                plan.imu_model,
                                plan.gravity_m_s2,
                                fitted ? flight::imu_seed(seed) : seed,
                                keep_going);
}

}  // namespace

Status add_inertial_data(const ExportSource& source,
                         const std::optional<flight::ImuModel>& wanted,
                         FrameSequence& frames,
                         const std::function<bool()>& keep_going,
                         DatasetPlan& plan) {
  const Scenario& scenario = source.scenario;
  const std::optional<flight::ImuModel>& fitted = scenario.sensors.imu;
  if (wanted && fitted) {
    return Error{ErrorCode::kInvalidArgument,
                 "imu: must not be given for a scenario with sensors.imu, whose samples are "
                 "exported"};
  }
  plan.imu_model = fitted ? *fitted : wanted.value_or(flight::ImuModel());
  const terrain::World& world = frames.maker().world();
  plan.gravity_m_s2 = flight::normal_gravity_m_s2(world.tiles->frame().origin());
  const std::int64_t margin_ns = frame_time_ns(1, scenario.rate);
  const std::int64_t begin_ns = frames.maker().frame_ns(frames.first_frame()) - margin_ns;
  const std::int64_t end_ns = frames.maker().frame_ns(frames.last_frame()) + margin_ns;
  Readings readings = std::vector<flight::ImuReading>();
  if (fitted && source.run) {
    readings = recorded_readings(*source.run, *fitted, scenario.seed, end_ns);
  } else if (!fitted && source.run) {
    readings = vehicle_readings(*source.run, end_ns, plan);
  }
  if (readings && readings->empty()) {
    readings = synthesized_readings(source, world, end_ns, keep_going, plan);
  }
  if (!readings) return readings.error();
  auto flight = open_truth(source, world);
  if (!flight) return flight.error();
  for (const flight::ImuReading& reading : *readings) {
    if (reading.sample.t_ns < begin_ns) continue;
    const auto state = (*flight)->state_at(reading.sample.t_ns);
    if (!state) return state.error();
    if (!*state) break;
    plan.imu.push_back(reading);
    plan.states.push_back(**state);
  }
  return {};
}

Result<FrameSamples> FrameSamples::open(const ExportSource& source) {
  FrameSamples samples(frame_time_ns(1, source.scenario.rate));
  if (!source.run) return samples;
  Result<SensorFilesReader> reader = SensorFilesReader::open(source.run->folder);
  if (!reader) return reader.error();
  samples.recorded_ = std::move(*reader);
  return samples;
}

Status FrameSamples::add_to(MadeFrame& frame) {
  const std::int64_t previous_ns =
      previous_ns_.value_or(frame.t_ns > 0 ? frame.t_ns - period_ns_ : kBeforeFlightNs);
  previous_ns_ = frame.t_ns;
  if (recorded_) {
    Result<SensorSamples> samples = recorded_->until(frame.t_ns, previous_ns);
    if (!samples) return samples.error();
    frame.sensors = std::move(*samples);
  } else {
    drop_available_at(frame.sensors, previous_ns);
  }
  return {};
}

}  // namespace overfly::server
