#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/course_plan.hpp"
#include "flight/flight.hpp"
#include "flight/ground_track.hpp"
#include "flight/height_profile.hpp"
#include "flight/known_flight.hpp"

namespace overfly::flight {
namespace {

struct Limit {
  const char* field;
  double value;
  double low;
  double high;
  bool low_allowed;
};

Status check(const Limit& limit) {
  const bool above = limit.low_allowed ? limit.value >= limit.low : limit.value > limit.low;
  if (above && limit.value <= limit.high) return {};
  return Error{ErrorCode::kInvalidArgument,
               std::string(limit.field) + " = " + short_text(limit.value) + ": must be in " +
                   (limit.low_allowed ? "[" : "(") + short_text(limit.low) + ", " +
                   short_text(limit.high) + "]"};
}

/// Reports angles in degrees under the field names of the scenario.
Status validate(const CourseParameters& p) {
  constexpr double kFarM = 1e6;
  for (const Limit& limit : {
           Limit{"airspeed_m_s", p.airspeed_m_s, 5.0, 80.0, true},
           Limit{"roll_rate_max_deg_s",
                 deg_from_rad(p.roll_rate_max_rad_s),
                 0.0,
                 deg_from_rad(3.5),
                 false},
           Limit{"height_agl_m", p.height_agl_m, 20.0, 3000.0, true},
           Limit{"bank_max_deg", deg_from_rad(p.bank_max_rad), 0.0, deg_from_rad(1.2), false},
           Limit{"length_m", p.length_m, 500.0, 100000.0, true},
           Limit{"leg_length_m", p.leg_length_m, 0.0, p.length_m, true},
           Limit{"start_east_m", p.start_east_m, -kFarM, kFarM, true},
           Limit{"start_north_m", p.start_north_m, -kFarM, kFarM, true},
           Limit{"heading_deg", deg_from_rad(p.heading_rad), -360.0, 360.0, true},
       }) {
    if (Status status = check(limit); !status) return status;
  }
  return {};
}

class Course final : public KnownFlight {
 public:
  Course(GroundTrack track, HeightProfile height, const CourseParameters& parameters)
      : KnownFlight("course: " + short_text(parameters.airspeed_m_s) + " m/s, " +
                    short_text(deg_from_rad(parameters.roll_rate_max_rad_s)) + " deg/s, " +
                    short_text(parameters.height_agl_m) + " m above the ground"),
        track_(std::move(track)),
        height_(std::move(height)),
        parameters_(parameters) {
    // The flight ends when the distance flown, including climbs, reaches the course's length.
    constexpr double kStepS = 0.01;
    double flown_m = 0.0;
    double t_s = 0.0;
    for (double speed = speed_at(0.0); t_s < track_.duration_s(); t_s += kStepS) {
      if (flown_m + speed * kStepS >= parameters.length_m) break;
      const double next = speed_at(t_s + kStepS);
      flown_m += 0.5 * (speed + next) * kStepS;
      speed = next;
    }
    t_s += std::max(0.0, parameters.length_m - flown_m) / speed_at(t_s);
    end_ns_ = ns_from_s(std::min(t_s, track_.duration_s()));
  }

 private:
  [[nodiscard]] std::int64_t end_ns() const override { return end_ns_; }

  [[nodiscard]] double speed_at(double t_s) const {
    return std::hypot(parameters_.airspeed_m_s, height_.at(t_s).climb_m_s);
  }

  /// The body's x axis points along the velocity; the bank is a rotation about it.
  [[nodiscard]] AircraftState state(std::int64_t t_ns) const override {
    const double t_s = s_from_ns(t_ns);
    const GroundSample ground = track_.at(t_s);
    const HeightSample height = height_.at(t_s);
    const BankSample bank = track_.bank_at(t_s);
    const double speed_m_s = parameters_.airspeed_m_s;  // equals ground speed: no wind

    AircraftState state;
    state.t_ns = t_ns;
    state.T_world_body.translation = {ground.east_m, ground.north_m, height.up_m};
    state.v_body_world_m_s = {speed_m_s * std::sin(ground.heading_rad),
                              speed_m_s * std::cos(ground.heading_rad),
                              height.climb_m_s};
    state.airspeed_m_s = state.v_body_world_m_s.norm();
    const double pitch_rad = std::atan2(height.climb_m_s, speed_m_s);
    state.T_world_body.rotation = R_world_body_from({bank.bank_rad, pitch_rad, ground.heading_rad});

    const double pitch_rate =
        height.climb_rate_m_s2 * speed_m_s / (state.airspeed_m_s * state.airspeed_m_s);
    const double heading_rate = ground.heading_rate_rad_s;
    // Body rates from the rates of the Z-Y-X angles (Stevens, Lewis, Johnson 2016, eq. 1.4-4).
    state.omega_body_rad_s = {bank.rate_rad_s - heading_rate * std::sin(pitch_rad),
                              pitch_rate * std::cos(bank.bank_rad) +
                                  heading_rate * std::cos(pitch_rad) * std::sin(bank.bank_rad),
                              -pitch_rate * std::sin(bank.bank_rad) +
                                  heading_rate * std::cos(pitch_rad) * std::cos(bank.bank_rad)};
    return state;
  }

  GroundTrack track_;
  HeightProfile height_;
  CourseParameters parameters_;
  std::int64_t end_ns_ = 0;
};

/// Checks that the smoothed height keeps its clearance over rough ground.
Status check_clearance(const GroundTrack& track,
                       const HeightProfile& height,
                       const CourseParameters& p,
                       const HeightQuery& ground) {
  constexpr double kStepS = 0.1;
  const double least_m = 0.25 * p.height_agl_m;
  for (double t_s = 0.0; t_s <= track.duration_s(); t_s += kStepS) {
    const GroundSample at = track.at(t_s);
    const double clearance_m = height.at(t_s).up_m - ground.ground_up_m(at.east_m, at.north_m);
    if (clearance_m < least_m) {
      return Error{ErrorCode::kInvalidArgument,
                   "height_agl_m = " + short_text(p.height_agl_m) + ": the course would pass " +
                       short_text(clearance_m) + " m above the ground at east " +
                       short_text(at.east_m) + " m, north " + short_text(at.north_m) +
                       " m, must be at least " + short_text(least_m) + " m"};
    }
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<TruthSource>> fly_course(const CourseParameters& parameters,
                                                std::shared_ptr<const HeightQuery> ground) {
  if (!ground)
    return Error{ErrorCode::kInvalidArgument, "the course requires a ground (height query)"};
  if (Status status = validate(parameters); !status) return status.error().in("course");
  const double speed_m_s = parameters.airspeed_m_s;
  GroundTrack track(
      plan_course(parameters),
      speed_m_s,
      {parameters.start_east_m, parameters.start_north_m, parameters.heading_rad, 0.0},
      parameters.length_m / speed_m_s);

  const HeightLimits limits{.knot_s = std::max(kHeightKnotM / speed_m_s, kHeightKnotS),
                            .climb_max_m_s = speed_m_s * std::tan(kClimbMaxRad)};
  Result<HeightProfile> height = HeightProfile::above(
      [&](double t_s) {
        const GroundSample at = track.at(t_s);
        return ground->ground_up_m(at.east_m, at.north_m);
      },
      parameters.height_agl_m,
      track.duration_s(),
      limits);
  if (!height) return height.error().in("course");
  if (Status status = check_clearance(track, *height, parameters, *ground); !status) {
    return status.error().in("course");
  }
  return std::unique_ptr<TruthSource>(
      std::make_unique<Course>(std::move(track), std::move(height).value(), parameters));
}

}  // namespace overfly::flight
