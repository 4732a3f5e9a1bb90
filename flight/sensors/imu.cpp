#include "flight/sensors/imu.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

namespace overfly::flight {
namespace {

/// The rotation vector of a unit quaternion [rad].
Eigen::Vector3d log_of(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  if (sine < 1e-12) return 2.0 * sign * q.vec();
  return sign * (2.0 * std::atan2(sine, std::abs(q.w())) / sine) * q.vec();
}

ImuReading mean_between(const AircraftState& from,
                        const AircraftState& middle,
                        const AircraftState& to,
                        double gravity_m_s2) {
  const double interval_s = s_from_ns(to.t_ns - from.t_ns);
  const Eigen::Quaterniond turn = from.T_world_body.rotation.conjugate() * to.T_world_body.rotation;
  const Eigen::Vector3d acceleration_world =
      (to.v_body_world_m_s - from.v_body_world_m_s) / interval_s;
  const Eigen::Vector3d gravity_world(0.0, 0.0, -gravity_m_s2);
  ImuReading reading;
  reading.sample.t_ns = middle.t_ns;
  reading.sample.interval_ns = 2 * (to.t_ns - middle.t_ns);
  reading.sample.angular_rate_rad_s = log_of(turn) / interval_s;
  reading.sample.acceleration_m_s2 =
      middle.T_world_body.rotation.conjugate() * (acceleration_world - gravity_world);
  return reading;
}

FrameRate half_steps_of(const ImuModel& model) {
  const FrameRate rate = FrameRate::from_hz(model.rate_hz).value();
  return {2 * rate.numerator, rate.denominator};
}

}  // namespace

void ImuErrors::apply(double interval_s, ImuReading& reading) {
  const double white = 1.0 / std::sqrt(interval_s);
  const double walk = std::sqrt(interval_s);
  gyroscope_bias_ += model_.gyroscope_walk_rad_s2_sqrt_hz * walk * draw();
  accelerometer_bias_ += model_.accelerometer_walk_m_s3_sqrt_hz * walk * draw();
  reading.gyroscope_bias_rad_s = gyroscope_bias_;
  reading.accelerometer_bias_m_s2 = accelerometer_bias_;
  reading.sample.angular_rate_rad_s +=
      gyroscope_bias_ + model_.gyroscope_noise_rad_s_sqrt_hz * white * draw();
  reading.sample.acceleration_m_s2 +=
      accelerometer_bias_ + model_.accelerometer_noise_m_s2_sqrt_hz * white * draw();
}

Eigen::Vector3d ImuErrors::draw() {
  Eigen::Vector3d numbers;
  for (int i = 0; i < 3; ++i) numbers(i) = noise_.draw();
  return numbers;
}

Imu::Imu(const ImuModel& model, double gravity_m_s2, std::uint64_t seed)
    : half_steps_(half_steps_of(model)), gravity_m_s2_(gravity_m_s2), errors_(model, seed) {}

std::optional<ImuReading> Imu::take(const AircraftState& state) {
  const bool is_middle = step_++ % 2 == 0;
  if (is_middle) {
    if (step_ == 1) from_ = state;
    middle_ = state;
    return std::nullopt;
  }
  ImuReading reading = mean_between(from_, middle_, state, gravity_m_s2_);
  errors_.apply(s_from_ns(state.t_ns - from_.t_ns), reading);
  from_ = state;
  return reading;
}

std::optional<ImuReading> Imu::take_end(const AircraftState& state) {
  const bool middle_reached = step_ % 2 == 1;
  if (!middle_reached || state.t_ns <= from_.t_ns) return std::nullopt;
  return take(state);
}

Result<std::vector<ImuReading>> with_biases(const std::vector<ImuSample>& samples,
                                            const ImuModel& model,
                                            std::uint64_t seed) {
  if (Status status = model.validate(); !status) return status.error();
  const FrameRate half_steps = half_steps_of(model);
  ImuErrors errors(model, seed);
  std::vector<ImuReading> readings;
  std::int64_t from_ns = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto k = static_cast<std::int64_t>(i);
    const std::int64_t expected_ns = frame_time_ns(2 * k, half_steps);
    if (samples[i].t_ns != expected_ns) {
      return Error{ErrorCode::kUnreadable,
                   "sample " + std::to_string(k) + ": t_ns = " + std::to_string(samples[i].t_ns) +
                       ": must be " + std::to_string(expected_ns)};
    }
    const std::int64_t to_ns = frame_time_ns(2 * k + 1, half_steps);
    ImuReading reading;
    errors.apply(s_from_ns(to_ns - from_ns), reading);
    reading.sample = samples[i];
    readings.push_back(reading);
    from_ns = to_ns;
  }
  return readings;
}

Result<std::vector<ImuReading>> synthesize_imu(TruthSource& flight,
                                               std::int64_t end_ns,
                                               const ImuModel& model,
                                               double gravity_m_s2,
                                               std::uint64_t seed,
                                               const std::function<bool()>& keep_going) {
  if (Status status = model.validate(); !status) return status.error();
  end_ns = std::min(end_ns, flight.duration_ns().value_or(end_ns));
  std::vector<ImuReading> readings;
  Imu imu(model, gravity_m_s2, seed);
  constexpr std::int64_t kStatesPerPoll = 2048;
  for (std::int64_t states = 0;; ++states) {
    if (states % kStatesPerPoll == 0 && keep_going && !keep_going()) {
      return Error{ErrorCode::kCancelled, "cancelled"};
    }
    const bool at_end = imu.next_ns() > end_ns;
    const auto state = flight.state_at(at_end ? end_ns : imu.next_ns());
    if (!state) return state.error();
    // A flight of unknown duration has ended.
    if (!*state) return readings;
    const std::optional<ImuReading> reading = at_end ? imu.take_end(**state) : imu.take(**state);
    if (reading) readings.push_back(*reading);
    if (at_end) return readings;
  }
}

}  // namespace overfly::flight
