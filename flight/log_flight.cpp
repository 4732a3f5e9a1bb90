#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "flight/flight.hpp"
#include "flight/log_reader.hpp"

namespace overfly::flight {
namespace {

/// Derivative at t1 of the parabola through three points (Lagrange).
Eigen::Vector3d parabola_velocity(double t_s,
                                  const std::pair<double, Eigen::Vector3d>& a,
                                  const std::pair<double, Eigen::Vector3d>& b,
                                  const std::pair<double, Eigen::Vector3d>& c) {
  const auto [ta, pa] = a;
  const auto [tb, pb] = b;
  const auto [tc, pc] = c;
  return pa * ((2 * t_s - tb - tc) / ((ta - tb) * (ta - tc))) +
         pb * ((2 * t_s - ta - tc) / ((tb - ta) * (tb - tc))) +
         pc * ((2 * t_s - ta - tb) / ((tc - ta) * (tc - tb)));
}

class LogFlight final : public TruthSource {
 public:
  LogFlight(FlightLog log, std::string description)
      : trajectory_(std::move(log.T_world_body)),
        warnings_(std::move(log.warnings)),
        description_(std::move(description)) {
    const std::size_t count = trajectory_.size();
    for (std::size_t i = 0; i < count; ++i) velocities_m_s_.push_back(velocity_of(i));
  }

  [[nodiscard]] Result<std::optional<AircraftState>> state_at(std::int64_t t_ns) override {
    const std::int64_t last_ns = *duration_ns();
    if (t_ns < 0) {
      return Error{ErrorCode::kInvalidArgument,
                   "t_ns = " + std::to_string(t_ns) + ": the flight spans [0, " +
                       std::to_string(last_ns) + "] ns"};
    }
    if (t_ns > last_ns) return std::optional<AircraftState>();
    const std::vector<StampedPose>& poses = trajectory_.poses();
    const std::int64_t file_ns = t_ns + trajectory_.begin_ns();
    const auto after = std::upper_bound(
        poses.begin(), poses.end() - 1, file_ns, [](std::int64_t t, const StampedPose& stamped) {
          return t < stamped.t_ns;
        });
    const auto pose = static_cast<std::size_t>(after - poses.begin()) - 1;
    return std::optional(between(pose, file_ns, t_ns));
  }

  [[nodiscard]] std::optional<std::int64_t> duration_ns() const override {
    return trajectory_.end_ns() - trajectory_.begin_ns();
  }
  [[nodiscard]] std::string description() const override { return description_; }
  [[nodiscard]] std::vector<std::string> warnings() const override { return warnings_; }

 private:
  [[nodiscard]] std::pair<double, Eigen::Vector3d> point(std::size_t i) const {
    const StampedPose& stamped = trajectory_.poses()[i];
    return {s_from_ns(stamped.t_ns - trajectory_.begin_ns()), stamped.pose.translation};
  }

  [[nodiscard]] Eigen::Vector3d velocity_of(std::size_t i) const {
    const std::size_t count = trajectory_.size();
    if (count == 2) {
      return (point(1).second - point(0).second) / (point(1).first - point(0).first);
    }
    const std::size_t middle = std::clamp<std::size_t>(i, 1, count - 2);
    return parabola_velocity(point(i).first, point(middle - 1), point(middle), point(middle + 1));
  }

  /// Cubic Hermite in position, SLERP in rotation, from pose i to i + 1.
  [[nodiscard]] AircraftState between(std::size_t i,
                                      std::int64_t file_ns,
                                      std::int64_t t_ns) const {
    const StampedPose& a = trajectory_.poses()[i];
    const StampedPose& b = trajectory_.poses()[i + 1];
    const double dt_s = s_from_ns(b.t_ns - a.t_ns);
    const double u = s_from_ns(file_ns - a.t_ns) / dt_s;
    const Eigen::Vector3d& p0 = a.pose.translation;
    const Eigen::Vector3d& p1 = b.pose.translation;
    const Eigen::Vector3d m0 = velocities_m_s_[i] * dt_s;
    const Eigen::Vector3d m1 = velocities_m_s_[i + 1] * dt_s;
    const double u2 = u * u;
    const double u3 = u2 * u;

    AircraftState state;
    state.t_ns = t_ns;
    state.T_world_body = interpolate(a.pose, b.pose, u);
    state.T_world_body.translation = (2 * u3 - 3 * u2 + 1) * p0 + (u3 - 2 * u2 + u) * m0 +
                                     (3 * u2 - 2 * u3) * p1 + (u3 - u2) * m1;
    state.v_body_world_m_s =
        ((6 * u2 - 6 * u) * (p0 - p1) + (3 * u2 - 4 * u + 1) * m0 + (3 * u2 - 2 * u) * m1) / dt_s;
    state.airspeed_m_s = state.v_body_world_m_s.norm();  // a pose file contains no wind
    Eigen::Quaterniond step = a.pose.rotation.conjugate() * b.pose.rotation;
    if (step.w() < 0.0) step.coeffs() = -step.coeffs();
    const Eigen::AngleAxisd turn(step);
    state.omega_body_rad_s = turn.axis() * (turn.angle() / dt_s);
    return state;
  }

  Trajectory trajectory_;
  std::vector<std::string> warnings_;
  std::vector<Eigen::Vector3d> velocities_m_s_;
  std::string description_;
};

}  // namespace

Result<std::unique_ptr<TruthSource>> fly_log(const std::filesystem::path& file,
                                             const LocalFrame& frame,
                                             bool camera_poses,
                                             const std::atomic<bool>* cancel) {
  Result<FlightLog> log = read_log(file, frame, camera_poses, cancel);
  if (!log) return log.error();
  if (log->T_world_body.size() < 2) {
    return Error{ErrorCode::kUnreadable,
                 file.string() + ": " + std::to_string(log->T_world_body.size()) +
                     " poses: a flight needs at least 2"};
  }
  return std::unique_ptr<TruthSource>(
      std::make_unique<LogFlight>(std::move(log).value(), "log: " + file.filename().string()));
}

}  // namespace overfly::flight
