#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/time.hpp"
#include "odometry/baseline/baseline_odometry.hpp"
#include "odometry/baseline/baseline_port.hpp"
#include "odometry/geometry/lie.hpp"

namespace overfly::odometry::baseline {
namespace {

constexpr double kSeaLevelDensity = 1.225;  // kg/m^3, of the indicated airspeed
constexpr double kGasConstant = 287.05287;  // J/(kg K), dry air (ISO 2533)
constexpr double kGravity = 9.80665;        // m/s^2
constexpr double kTiltGain_1_s = 0.2;       // of the accelerometers
constexpr double kHeadingGain_1_s = 0.5;    // of the compass
/// Angular rates are not integrated over a longer gap in the samples, and after one the compass
/// corrects as after so long. Between frames that are farther apart the way is made in such steps.
constexpr double kLongestStep_s = 1.0;

/// Attitude and heading from gyroscopes, accelerometers and compass. The frame "level" is
/// north-west-up of the first compass reading: its x axis points to where the nose did.
///
/// Method: complementary filter (Mahony, Hamel and Pflimlin 2008, eq. 32, without bias), with the
/// centripetal acceleration of coordinated flight, omega x v, taken from the specific force.
class Attitude {
 public:
  [[nodiscard]] const Eigen::Quaterniond& R_level_body() const { return R_level_body_; }
  [[nodiscard]] bool known() const { return reference_.has_value(); }

  void add(const ImuSample& sample, double airspeed_m_s) {
    const Eigen::Vector3d omega = sample.angular_rate_rad_s;
    const double since_s = step_s(imu_ns_, sample.t_ns);
    const double dt_s = since_s <= kLongestStep_s ? since_s : 0.0;
    if (!omega.allFinite() || !sample.acceleration_m_s2.allFinite()) return;
    has_rates_ = true;
    const Eigen::Vector3d centripetal = omega.cross(Eigen::Vector3d(airspeed_m_s, 0.0, 0.0));
    const Eigen::Vector3d up_measured = sample.acceleration_m_s2 - centripetal;
    Eigen::Vector3d correction = Eigen::Vector3d::Zero();
    if (up_measured.norm() > 0.3 * kGravity && up_measured.norm() < 3.0 * kGravity) {
      const Eigen::Vector3d up = R_level_body_.conjugate() * Eigen::Vector3d::UnitZ();
      correction = kTiltGain_1_s * up_measured.normalized().cross(up);
    }
    R_level_body_ = (R_level_body_ * exp_so3((omega + correction) * dt_s)).normalized();
  }

  void add(const MagnetometerSample& sample) {
    if (!sample.field_ut.allFinite()) return;
    const double dt_s = std::min(step_s(compass_ns_, sample.t_ns), kLongestStep_s);
    const Eigen::Vector3d field = R_level_body_ * sample.field_ut;
    if (!(field.head<2>().norm() > 0.0)) return;
    const double direction_rad = std::atan2(field.y(), field.x());
    if (!reference_) {
      reference_ = direction_rad;
      return;
    }
    const double error_rad = wrap_pi(*reference_ - direction_rad);
    // Without gyroscopes the compass alone gives the heading.
    const double share = has_rates_ ? std::min(1.0, kHeadingGain_1_s * dt_s) : 1.0;
    R_level_body_ = (exp_so3({0.0, 0.0, share * error_rad}) * R_level_body_).normalized();
  }

 private:
  /// Seconds since the last sample of a kind; 0 for the first one.
  static double step_s(std::optional<std::int64_t>& last_ns, std::int64_t t_ns) {
    const double dt_s = last_ns ? s_from_ns(t_ns - *last_ns) : 0.0;
    last_ns = t_ns;
    return std::max(0.0, dt_s);
  }

  /// body is forward-right-down: level flight.
  Eigen::Quaterniond R_level_body_{0.0, 1.0, 0.0, 0.0};
  std::optional<double> reference_;  ///< direction of the field at the start [rad]
  std::optional<std::int64_t> imu_ns_;
  std::optional<std::int64_t> compass_ns_;
  bool has_rates_ = false;
};

class DeadReckoning final : public BaselinePort {
 public:
  explicit DeadReckoning(const Pose& T_body_camera) : T_body_camera_(T_body_camera) {}

  [[nodiscard]] std::string type() const override { return "baseline_dead_reckoning"; }

 private:
  void answer(const VoFrame& frame, VoEstimate& estimate) override {
    take(frame.sensors);
    if (!airspeed_m_s_ || !attitude_.known()) {
      if (!told_ && frame.index > 100) {
        told_ = true;
        log(std::string("no samples of ") + (airspeed_m_s_ ? "the compass" : "airspeed") +
            ": the scenario's sensors must have airspeed and magnetometer");
      }
      return;
    }
    move_to(frame.t_ns);
    const Pose T_level_body{attitude_.R_level_body(), p_level_m_};
    estimate.sample.state = TrackingState::kTracking;
    estimate.sample.T_vo_camera = T_level_body * T_body_camera_;
    estimate.counters["airspeed_m_s"] = *airspeed_m_s_;
  }

  void take(const SensorSamples& samples) {
    for (const BarometerSample& sample : samples.barometer) take(sample);
    for (const AirspeedSample& sample : samples.airspeed) take(sample);
    for (const ImuSample& sample : samples.imu) {
      attitude_.add(sample, airspeed_m_s_.value_or(0.0));
      move_between_frames(sample.t_ns);
    }
    for (const MagnetometerSample& sample : samples.magnetometer) {
      attitude_.add(sample);
      move_between_frames(sample.t_ns);
    }
  }

  void take(const BarometerSample& sample) {
    if (!(sample.pressure_pa > 0.0) || !(sample.temperature_k > 0.0)) return;
    density_kg_m3_ = sample.pressure_pa / (kGasConstant * sample.temperature_k);
    // Hypsometric equation with the temperature of the first sample.
    if (!first_barometer_) first_barometer_ = sample;
    height_m_ = -kGasConstant * first_barometer_->temperature_k / kGravity *
                std::log(sample.pressure_pa / first_barometer_->pressure_pa);
  }

  void take(const AirspeedSample& sample) {
    if (!std::isfinite(sample.indicated_airspeed_m_s)) return;
    const double true_m_s =
        std::max(0.0, sample.indicated_airspeed_m_s) * std::sqrt(kSeaLevelDensity / density_kg_m3_);
    // Pitot tubes are noisy: the mean over about a second.
    airspeed_m_s_ = airspeed_m_s_ ? 0.9 * *airspeed_m_s_ + 0.1 * true_m_s : true_m_s;
  }

  /// Follows the turns between frames that are far apart.
  void move_between_frames(std::int64_t t_ns) {
    if (moved_ns_ && s_from_ns(t_ns - *moved_ns_) > kLongestStep_s) move_to(t_ns);
  }

  /// With the last known airspeed.
  void move_to(std::int64_t t_ns) {
    const double dt_s = moved_ns_ ? s_from_ns(t_ns - *moved_ns_) : 0.0;
    moved_ns_ = t_ns;
    const Eigen::Vector2d nose = (attitude_.R_level_body() * Eigen::Vector3d::UnitX()).head<2>();
    if (nose.norm() > 1e-6) {
      p_level_m_.head<2>() += *airspeed_m_s_ * dt_s * nose.normalized();
    }
    p_level_m_.z() = height_m_;
  }

  const Pose T_body_camera_;
  Attitude attitude_;
  std::optional<double> airspeed_m_s_;
  double density_kg_m3_ = kSeaLevelDensity;
  std::optional<BarometerSample> first_barometer_;
  double height_m_ = 0.0;  ///< above the first sample
  std::optional<std::int64_t> moved_ns_;
  Eigen::Vector3d p_level_m_ = Eigen::Vector3d::Zero();
  bool told_ = false;
};

}  // namespace

std::unique_ptr<VoPort> create_dead_reckoning(const Pose& T_body_camera) {
  return std::make_unique<DeadReckoning>(T_body_camera);
}

}  // namespace overfly::odometry::baseline
