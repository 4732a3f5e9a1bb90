#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "flight/flight.hpp"
#include "flight/known_flight.hpp"
#include "flight/log_reader.hpp"
#include "flight/pose_flight.hpp"

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

class LogFlight final : public KnownFlight {
 public:
  LogFlight(Trajectory T_world_body,
            std::vector<StampedRotation> rotations,
            std::vector<std::string> warnings,
            std::string description)
      : KnownFlight(std::move(description), std::move(warnings)),
        trajectory_(std::move(T_world_body)),
        rotations_(std::move(rotations)) {
    const std::size_t count = trajectory_.size();
    for (std::size_t i = 0; i < count; ++i) velocities_m_s_.push_back(velocity_of(i));
  }

  [[nodiscard]] std::optional<std::int64_t> log_start_ns() const override {
    return trajectory_.begin_ns();
  }

 private:
  [[nodiscard]] std::int64_t end_ns() const override {
    return trajectory_.end_ns() - trajectory_.begin_ns();
  }
  [[nodiscard]] AircraftState state(std::int64_t t_ns) const override {
    const std::vector<StampedPose>& poses = trajectory_.poses();
    const std::int64_t file_ns = t_ns + trajectory_.begin_ns();
    const auto after = std::upper_bound(
        poses.begin(), poses.end() - 1, file_ns, [](std::int64_t t, const StampedPose& stamped) {
          return t < stamped.t_ns;
        });
    const auto pose = static_cast<std::size_t>(after - poses.begin()) - 1;
    AircraftState state = between(pose, t_ns);
    if (!rotations_.empty()) turn(file_ns, state);
    return state;
  }

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

  /// The file's row i as a state of the flight.
  [[nodiscard]] AircraftState row_state(std::size_t i) const {
    const StampedPose& row = trajectory_.poses()[i];
    AircraftState state;
    state.t_ns = row.t_ns - trajectory_.begin_ns();
    state.T_world_body = row.pose;
    state.v_body_world_m_s = velocities_m_s_[i];
    return state;
  }

  /// The angular rate of the SLERP from a to b, in body [rad/s].
  static Eigen::Vector3d rate_between(const Eigen::Quaterniond& R_world_a,
                                      const Eigen::Quaterniond& R_world_b,
                                      std::int64_t step_ns) {
    Eigen::Quaterniond step = R_world_a.conjugate() * R_world_b;
    if (step.w() < 0.0) step.coeffs() = -step.coeffs();
    const Eigen::AngleAxisd turn(step);
    return turn.axis() * (turn.angle() / s_from_ns(step_ns));
  }

  /// Gives a state the attitude and the angular rate of the rotations around its time.
  void turn(std::int64_t file_ns, AircraftState& state) const {
    const auto next = std::upper_bound(
        rotations_.begin() + 1,
        rotations_.end() - 1,
        file_ns,
        [](std::int64_t t, const StampedRotation& rotation) { return t < rotation.t_ns; });
    const StampedRotation& a = *(next - 1);
    const StampedRotation& b = *next;
    const double alpha =
        static_cast<double>(file_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
    state.T_world_body.rotation = a.R_world_body.slerp(alpha, b.R_world_body).normalized();
    state.omega_body_rad_s = rate_between(a.R_world_body, b.R_world_body, b.t_ns - a.t_ns);
  }

  /// From row i to i + 1; the angular rate is that of the SLERP.
  [[nodiscard]] AircraftState between(std::size_t i, std::int64_t t_ns) const {
    const AircraftState a = row_state(i);
    const AircraftState b = row_state(i + 1);
    AircraftState state = interpolate(a, b, t_ns);
    state.airspeed_m_s = state.v_body_world_m_s.norm();  // a pose file contains no wind
    state.omega_body_rad_s =
        rate_between(a.T_world_body.rotation, b.T_world_body.rotation, b.t_ns - a.t_ns);
    return state;
  }

  Trajectory trajectory_;
  std::vector<StampedRotation> rotations_;
  std::vector<Eigen::Vector3d> velocities_m_s_;
};

}  // namespace

std::unique_ptr<TruthSource> fly_poses(Trajectory T_world_body,
                                       std::vector<StampedRotation> rotations,
                                       std::vector<std::string> warnings,
                                       std::string description) {
  return std::make_unique<LogFlight>(
      std::move(T_world_body), std::move(rotations), std::move(warnings), std::move(description));
}

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
  return fly_poses(std::move(log->T_world_body),
                   {},
                   std::move(log->warnings),
                   "log: " + file.filename().string());
}

}  // namespace overfly::flight
