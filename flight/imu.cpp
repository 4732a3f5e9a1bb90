#include "flight/imu.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/time.hpp"
#include "flight/normal_noise.hpp"

namespace overfly::flight {
namespace {

/// The rotation vector of a unit quaternion [rad].
Eigen::Vector3d log_of(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  if (sine < 1e-12) return 2.0 * sign * q.vec();
  return sign * (2.0 * std::atan2(sine, std::abs(q.w())) / sine) * q.vec();
}

/// Adds noise and bias. Draws the same random numbers for all noise densities.
class ErrorModel {
 public:
  ErrorModel(const ImuModel& model, std::uint64_t seed) : model_(model), noise_(seed) {}

  void apply(double interval_s, ImuReading& reading) {
    const double white = 1.0 / std::sqrt(interval_s);
    const double walk = std::sqrt(interval_s);
    gyroscope_bias_ += model_.gyroscope_walk_rad_s2_sqrt_hz * walk * draw();
    accelerometer_bias_ += model_.accelerometer_walk_m_s3_sqrt_hz * walk * draw();
    reading.gyroscope_bias_rad_s = gyroscope_bias_;
    reading.accelerometer_bias_m_s2 = accelerometer_bias_;
    reading.angular_rate_rad_s +=
        gyroscope_bias_ + model_.gyroscope_noise_rad_s_sqrt_hz * white * draw();
    reading.specific_force_m_s2 +=
        accelerometer_bias_ + model_.accelerometer_noise_m_s2_sqrt_hz * white * draw();
  }

 private:
  Eigen::Vector3d draw() {
    Eigen::Vector3d numbers;
    for (int i = 0; i < 3; ++i) numbers(i) = noise_.draw();
    return numbers;
  }

  ImuModel model_;
  NormalNoise noise_;
  Eigen::Vector3d gyroscope_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_ = Eigen::Vector3d::Zero();
};

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
  reading.t_ns = middle.t_ns;
  reading.angular_rate_rad_s = log_of(turn) / interval_s;
  reading.specific_force_m_s2 =
      middle.T_world_body.rotation.conjugate() * (acceleration_world - gravity_world);
  return reading;
}

Error out_of_range(const std::string& field, double value, const std::string& limit) {
  return {ErrorCode::kInvalidArgument,
          "imu." + field + " = " + std::to_string(value) + ": must be " + limit};
}

}  // namespace

ImuModel ImuModel::ideal(double rate_hz) { return {rate_hz, 0.0, 0.0, 0.0, 0.0}; }

Status ImuModel::validate() const {
  if (!(rate_hz > 0.0 && rate_hz <= 10000.0)) {
    return out_of_range("rate_hz", rate_hz, "in (0, 10000]");
  }
  for (const auto& [field, value] :
       {std::pair{"gyroscope_noise_rad_s_sqrt_hz", gyroscope_noise_rad_s_sqrt_hz},
        {"gyroscope_walk_rad_s2_sqrt_hz", gyroscope_walk_rad_s2_sqrt_hz},
        {"accelerometer_noise_m_s2_sqrt_hz", accelerometer_noise_m_s2_sqrt_hz},
        {"accelerometer_walk_m_s3_sqrt_hz", accelerometer_walk_m_s3_sqrt_hz}}) {
    if (!(value >= 0.0 && value < 1e3)) return out_of_range(field, value, "in [0, 1000)");
  }
  return {};
}

Result<std::vector<ImuReading>> synthesize_imu(TruthSource& flight,
                                               std::int64_t end_ns,
                                               const ImuModel& model,
                                               double gravity_m_s2,
                                               std::uint64_t seed,
                                               const std::function<bool()>& keep_going) {
  if (Status status = model.validate(); !status) return status.error();
  const Result<FrameRate> rate = FrameRate::from_hz(model.rate_hz);
  if (!rate) return rate.error().in("imu.rate_hz");
  // Twice the rate: the odd stamps lie between the samples.
  const FrameRate half_steps{2 * rate->numerator, rate->denominator};
  end_ns = std::min(end_ns, flight.duration_ns().value_or(end_ns));

  std::vector<ImuReading> readings;
  ErrorModel errors(model, seed);
  const auto from = flight.state_at(0);
  if (!from) return from.error();
  if (!*from) return readings;
  AircraftState before = **from;
  for (std::int64_t k = 0;; ++k) {
    if (k % 1024 == 0 && keep_going && !keep_going()) {
      return Error{ErrorCode::kCancelled, "cancelled"};
    }
    const std::int64_t t_ns = frame_time_ns(2 * k, half_steps);
    const std::int64_t after_ns = std::min(frame_time_ns(2 * k + 1, half_steps), end_ns);
    if (t_ns > end_ns || after_ns <= before.t_ns) return readings;
    const auto middle = flight.state_at(t_ns);
    if (!middle) return middle.error();
    const auto after = *middle ? flight.state_at(after_ns) : middle;
    if (!after) return after.error();
    // A flight of unknown duration has ended.
    if (!*after) return readings;
    ImuReading reading = mean_between(before, **middle, **after, gravity_m_s2);
    errors.apply(s_from_ns((*after)->t_ns - before.t_ns), reading);
    readings.push_back(reading);
    before = **after;
  }
}

}  // namespace overfly::flight
