#include "flight/dynamics/trim.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "core/motion/pose.hpp"
#include "core/text/number_text.hpp"
#include "flight/dynamics/aerodynamics.hpp"
#include "flight/dynamics/steady_motion.hpp"

namespace overfly::dynamics {
namespace {

using Unknowns = Eigen::Matrix<double, 7, 1>;
enum Unknown { kAlpha, kBeta, kTurn, kElevator, kAileron, kRudder, kPower };

std::string rounded(double value) { return number_text(std::round(value * 1000.0) / 1000.0); }

Error untrimmable(const TrimRequest& request, const std::string& fault) {
  return {ErrorCode::kInvalidArgument,
          "airspeed_m_s = " + number_text(request.airspeed_m_s) + ": " + fault};
}

Status check_request(const TrimRequest& request) {
  const auto check = [](const char* field, double value, bool holds, const char* limit) -> Status {
    if (holds) return {};
    return Error{ErrorCode::kInvalidArgument,
                 std::string(field) + " = " + number_text(value) + ": must be " + limit};
  };
  const double v = request.airspeed_m_s;
  if (Status s = check("airspeed_m_s", v, v > 0.0 && v <= 300.0, "in (0, 300]"); !s) return s;
  const double climb_deg = deg_from_rad(request.climb_rad);
  if (Status s = check("climb_deg", climb_deg, std::abs(climb_deg) < 60.0, "in (-60, 60)"); !s) {
    return s;
  }
  const double bank = request.bank_rad;
  if (Status s = check("bank_deg", deg_from_rad(bank), std::abs(bank) < 1.4, "in (-80.2, 80.2)");
      !s) {
    return s;
  }
  const double radius = request.radius_m.value_or(1.0);
  if (Status s = check("radius_m",
                       radius,
                       std::abs(radius) >= 1.0 && std::abs(radius) <= 1e9,
                       "at least 1 to either side");
      !s) {
    return s;
  }
  const double throttle = request.throttle.value_or(0.0);
  return check("throttle", throttle, throttle >= 0.0 && throttle <= 1.0, "in [0, 1]");
}

/// The equations of one request: seven residuals of seven unknowns.
class TrimProblem {
 public:
  TrimProblem(const Airframe& airframe, const Environment& environment, const TrimRequest& request)
      : airframe_(airframe),
        gravity_m_s2_(environment.gravity_m_s2),
        density_kg_m3_(environment.density_kg_m3(request.up_m)),
        request_(request) {}

  /// The third unknown is the turn rate where a bank is given, else the bank.
  [[nodiscard]] bool bank_given() const { return !request_.radius_m && request_.bank_rad != 0.0; }

  [[nodiscard]] Unknowns guess() const {
    const double v = request_.airspeed_m_s;
    const double bank = bank_guess();
    const double pressure = 0.5 * density_kg_m3_ * v * v * airframe_.wing.area_m2;
    const double lift =
        airframe_.mass_kg * gravity_m_s2_ * std::cos(request_.climb_rad) / std::cos(bank);
    Unknowns x = Unknowns::Zero();
    x(kAlpha) = std::clamp((lift / pressure - airframe_.lift.zero) / airframe_.lift.alpha,
                           -0.8 * airframe_.stall.alpha_rad,
                           0.8 * airframe_.stall.alpha_rad);
    x(kTurn) = bank_given() ? gravity_m_s2_ * std::tan(bank) / v : bank;
    x(kElevator) =
        -(airframe_.pitch.zero + airframe_.pitch.alpha * x(kAlpha)) / airframe_.pitch.elevator;
    x(kPower) = request_.throttle ? -0.1 : 0.5;
    return x;
  }

  [[nodiscard]] double bank_guess() const {
    if (!request_.radius_m) return request_.bank_rad;
    return std::atan(request_.airspeed_m_s * request_.airspeed_m_s /
                     (gravity_m_s2_ * *request_.radius_m));
  }

  [[nodiscard]] Trim flight(const Unknowns& x) const {
    Trim trim;
    trim.airspeed_m_s = request_.airspeed_m_s;
    trim.up_m = request_.up_m;
    trim.alpha_rad = x(kAlpha);
    trim.beta_rad = x(kBeta);
    trim.climb_rad = request_.throttle ? x(kPower) : request_.climb_rad;
    trim.controls = {x(kElevator), x(kAileron), x(kRudder), request_.throttle.value_or(x(kPower))};
    trim.roll_rad = bank_given() ? request_.bank_rad : x(kTurn);
    trim.turn_rate_rad_s = bank_given() ? x(kTurn)
                           : request_.radius_m
                               ? trim.airspeed_m_s * std::cos(trim.climb_rad) / *request_.radius_m
                               : 0.0;
    // Pitch of a path angle (Stevens & Lewis, Aircraft Control and Simulation, ch. 3).
    const double a = std::cos(trim.alpha_rad) * std::cos(trim.beta_rad);
    const double b = std::sin(trim.roll_rad) * std::sin(trim.beta_rad) +
                     std::cos(trim.roll_rad) * std::sin(trim.alpha_rad) * std::cos(trim.beta_rad);
    const double s = std::sin(trim.climb_rad);
    trim.pitch_rad =
        std::atan2(a * b + s * std::sqrt(std::max(0.0, a * a - s * s + b * b)), a * a - s * s);
    return trim;
  }

  [[nodiscard]] Unknowns residual(const Unknowns& x) const {
    const Trim at = flight(x);
    const FlightPointMotion motion =
        motion_at(airframe_,
                  gravity_m_s2_,
                  density_kg_m3_,
                  {at.v_body_m_s(), at.omega_body_rad_s(), at.roll_rad, at.pitch_rad, at.controls});
    Unknowns f;
    f << motion.acceleration_m_s2, motion.angular_acceleration_rad_s2, motion.side_force_m_s2;
    return f;
  }

  /// Newton's method with steps halved until they help.
  [[nodiscard]] Unknowns solve() const {
    constexpr int kIterations = 100;
    Unknowns x = guess();
    Unknowns f = residual(x);
    for (int i = 0; i < kIterations && f.lpNorm<Eigen::Infinity>() > 0.01 * kTrimResidual; ++i) {
      const Eigen::Matrix<double, 7, 7> slope = jacobian(x);
      const Unknowns full = slope.fullPivLu().solve(f);
      double part = std::min(1.0, 0.5 / std::max(1e-9, full.lpNorm<Eigen::Infinity>()));
      Unknowns next = x;
      Unknowns next_f = f;
      bool better = false;
      for (; part > 1e-6 && !better; part *= 0.5) {
        next = x - part * full;
        next_f = residual(next);
        better = next_f.norm() < f.norm();
      }
      if (!better) break;
      x = next;
      f = next_f;
    }
    return x;
  }

 private:
  [[nodiscard]] Eigen::Matrix<double, 7, 7> jacobian(const Unknowns& x) const {
    constexpr double kStep = 1e-6;
    Eigen::Matrix<double, 7, 7> slope;
    for (int i = 0; i < 7; ++i) {
      Unknowns forward = x;
      Unknowns backward = x;
      forward(i) += kStep;
      backward(i) -= kStep;
      slope.col(i) = (residual(forward) - residual(backward)) / (2.0 * kStep);
    }
    return slope;
  }

  const Airframe& airframe_;
  double gravity_m_s2_;
  double density_kg_m3_;
  TrimRequest request_;
};

/// Why a flight without a solution has none: the forces of straight flight with this lift.
Error explain(const Airframe& airframe,
              const Environment& environment,
              const TrimRequest& request,
              double bank_rad) {
  const double density = environment.density_kg_m3(request.up_m);
  const double v = request.airspeed_m_s;
  const double pressure = 0.5 * density * v * v * airframe.wing.area_m2;
  const double weight = airframe.mass_kg * environment.gravity_m_s2;
  const double load = std::cos(request.climb_rad) / std::cos(bank_rad);
  const StallPoint stall = stall_point(airframe);
  const double stall_m_s = stall_speed_m_s(airframe, environment, request.up_m, load);
  const std::string stall_text =
      "the stall speed with load factor " + rounded(load) + " is " + rounded(stall_m_s) + " m/s";
  if (v <= stall_m_s) return untrimmable(request, "too slow: " + stall_text);
  const double alpha = std::min(
      stall.alpha_rad, (load * weight / pressure - airframe.lift.zero) / airframe.lift.alpha);
  const double needed =
      pressure * lift_drag(airframe, alpha).drag + weight * std::sin(request.climb_rad);
  const double most = propeller(airframe.propulsion, v, 1.0, density).thrust_n;
  const double least = propeller(airframe.propulsion, v, 0.0, density).thrust_n;
  if (!request.throttle && needed > most) {
    return untrimmable(request,
                       "climb " + rounded(deg_from_rad(request.climb_rad)) + " deg needs about " +
                           rounded(needed) + " N, the thrust limit is " + rounded(most) + " N");
  }
  if (!request.throttle && needed < least) {
    return untrimmable(request,
                       "climb " + rounded(deg_from_rad(request.climb_rad)) + " deg needs about " +
                           rounded(needed) + " N, the thrust without power is " + rounded(least) +
                           " N: too steep a descent");
  }
  return untrimmable(request, "no steady flight was found; " + stall_text);
}

/// Checks a solution against the limits of the wing and the actuators.
Status check_limits(const Airframe& airframe,
                    const Environment& environment,
                    const TrimRequest& request,
                    const Trim& trim) {
  const StallPoint stall = stall_point(airframe);
  if (trim.alpha_rad > stall.alpha_rad || trim.alpha_rad < -airframe.stall.alpha_rad) {
    const double load = std::cos(trim.climb_rad) / std::cos(trim.roll_rad);
    return untrimmable(
        request,
        "too slow: needs an angle of attack of " + rounded(deg_from_rad(trim.alpha_rad)) +
            " deg, the stall is at " + rounded(deg_from_rad(stall.alpha_rad)) +
            " deg; the stall speed with load factor " + rounded(load) + " is " +
            rounded(stall_speed_m_s(airframe, environment, request.up_m, load)) + " m/s");
  }
  if (trim.controls.throttle > 1.0) {
    return untrimmable(request,
                       "needs throttle " + rounded(trim.controls.throttle) +
                           ": more thrust than the limit of throttle 1");
  }
  if (trim.controls.throttle < 0.0) {
    return untrimmable(request,
                       "needs throttle " + rounded(trim.controls.throttle) +
                           ": the thrust without power is already more");
  }
  for (const auto& [name, value, limits] :
       {std::tuple{"elevator", trim.controls.elevator_rad, &airframe.elevator},
        {"aileron", trim.controls.aileron_rad, &airframe.aileron},
        {"rudder", trim.controls.rudder_rad, &airframe.rudder}}) {
    if (value < limits->min_rad || value > limits->max_rad) {
      return untrimmable(request,
                         std::string("needs ") + name + " " + rounded(deg_from_rad(value)) +
                             " deg: the limits are " + rounded(deg_from_rad(limits->min_rad)) +
                             " and " + rounded(deg_from_rad(limits->max_rad)) + " deg");
    }
  }
  return {};
}

}  // namespace

Eigen::Vector3d Trim::v_body_m_s() const {
  return airspeed_m_s * Eigen::Vector3d(std::cos(alpha_rad) * std::cos(beta_rad),
                                        std::sin(beta_rad),
                                        std::sin(alpha_rad) * std::cos(beta_rad));
}

Eigen::Vector3d Trim::omega_body_rad_s() const {
  return turn_rate_rad_s * Eigen::Vector3d(-std::sin(pitch_rad),
                                           std::sin(roll_rad) * std::cos(pitch_rad),
                                           std::cos(roll_rad) * std::cos(pitch_rad));
}

BodyState Trim::state(const Eigen::Vector3d& position_world_m,
                      double yaw_rad,
                      const Eigen::Vector3d& wind_world_m_s) const {
  BodyState state;
  state.position_world_m = position_world_m;
  state.R_world_body = R_world_body_from({roll_rad, pitch_rad, yaw_rad});
  state.v_body_m_s = v_body_m_s() + state.R_world_body.conjugate() * wind_world_m_s;
  state.omega_body_rad_s = omega_body_rad_s();
  return state;
}

double stall_speed_m_s(const Airframe& airframe,
                       const Environment& environment,
                       double up_m,
                       double load_factor) {
  return std::sqrt(
      2.0 * load_factor * airframe.mass_kg * environment.gravity_m_s2 /
      (environment.density_kg_m3(up_m) * airframe.wing.area_m2 * stall_point(airframe).lift));
}

Result<Trim> trim(const Airframe& airframe,
                  const Environment& environment,
                  const TrimRequest& request) {
  if (Status status = check_request(request); !status) return status.error();
  const TrimProblem problem(airframe, environment, request);
  const Unknowns solution = problem.solve();
  Trim found = problem.flight(solution);
  found.residual = problem.residual(solution).lpNorm<Eigen::Infinity>();
  if (!(found.residual <= kTrimResidual)) {
    return explain(airframe, environment, request, problem.bank_guess());
  }
  if (Status status = check_limits(airframe, environment, request, found); !status) {
    return status.error();
  }
  return found;
}

}  // namespace overfly::dynamics
