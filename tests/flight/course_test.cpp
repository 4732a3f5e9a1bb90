#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/time.hpp"
#include "flight/flight.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight {
namespace {

using overfly::testing::larger_error;
using ::testing::HasSubstr;

std::unique_ptr<TruthSource> fly(
    const CourseParameters& parameters,
    std::shared_ptr<const HeightQuery> ground = std::make_shared<FlatGround>(100.0)) {
  Result<std::unique_ptr<TruthSource>> flight = fly_course(parameters, std::move(ground));
  EXPECT_TRUE(flight.ok()) << (flight.ok() ? "" : flight.error().message);
  return flight.ok() ? std::move(flight).value() : nullptr;
}

/// States every 1/100 s.
std::vector<AircraftState> sampled(TruthSource& flight) {
  std::vector<AircraftState> states;
  for (std::int64_t t_ns = 0; t_ns <= *flight.duration_ns(); t_ns += 10'000'000) {
    states.push_back(flight.state_at(t_ns).value().value());
  }
  return states;
}

RollPitchYaw attitude(const AircraftState& state) {
  return attitude_from(state.T_world_body.rotation);
}

/// The paper's sweep of airspeed and roll rate.
struct Case {
  double airspeed_m_s;
  double roll_rate_deg_s;
};

class CourseSweep : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    parameters_.airspeed_m_s = GetParam().airspeed_m_s;
    parameters_.roll_rate_max_rad_s = rad_from_deg(GetParam().roll_rate_deg_s);
    flight_ = fly(parameters_);
    ASSERT_NE(flight_, nullptr);
    states_ = sampled(*flight_);
  }
  CourseParameters parameters_;
  std::unique_ptr<TruthSource> flight_;
  std::vector<AircraftState> states_;
};

TEST_P(CourseSweep, IsAsLongAsAsked) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < states_.size(); ++i) {
    length_m +=
        (states_[i].T_world_body.translation - states_[i - 1].T_world_body.translation).norm();
  }
  EXPECT_NEAR(length_m, 3300.0, 1.0);
  EXPECT_NEAR(s_from_ns(*flight_->duration_ns()), 3300.0 / GetParam().airspeed_m_s, 1e-6);
}

TEST_P(CourseSweep, BeginsStraightAndLevelSouthbound) {
  const double leg_s = parameters_.leg_length_m / parameters_.airspeed_m_s;
  for (const AircraftState& state : states_) {
    const double t_s = s_from_ns(state.t_ns);
    if (t_s > leg_s) break;
    const Eigen::Vector3d expected(0.0, -parameters_.airspeed_m_s * t_s, 400.0);
    ASSERT_LT((state.T_world_body.translation - expected).norm(), 1e-8) << t_s;
    ASSERT_NEAR(attitude(state).roll_rad, 0.0, 1e-12);
    ASSERT_NEAR(attitude(state).pitch_rad, 0.0, 1e-12);
    ASSERT_NEAR(std::abs(attitude(state).yaw_rad), kPi, 1e-9);
  }
}

TEST_P(CourseSweep, ReturnsNorthToBesideItsStart) {
  const Eigen::Vector3d end = states_.back().T_world_body.translation;
  EXPECT_NEAR(end.y(), 0.0, 150.0);
  EXPECT_LT(std::abs(end.x()), 250.0);
  double southmost_m = 0.0;
  for (const AircraftState& state : states_) {
    southmost_m = std::min(southmost_m, state.T_world_body.translation.y());
    EXPECT_LT(std::abs(state.T_world_body.translation.x()), 300.0);
  }
  EXPECT_LT(southmost_m, -parameters_.leg_length_m);
}

TEST_P(CourseSweep, EveryReversalReachesTheRollRateLimitAndNeverExceedsIt) {
  const double limit = parameters_.roll_rate_max_rad_s;
  std::vector<double> peaks;  // of |roll rate| around each crossing of wings level
  double peak = 0.0;
  double previous_roll = 0.0;
  for (const AircraftState& state : states_) {
    const double rate = std::abs(state.omega_body_rad_s.x());
    ASSERT_LE(rate, limit * (1.0 + 1e-9));
    const double roll = attitude(state).roll_rad;
    if (rate < 1e-6) {
      peak = 0.0;
    } else {
      peak = std::max(peak, rate);
    }
    if (previous_roll != 0.0 && roll * previous_roll < 0.0) peaks.push_back(0.0);
    if (!peaks.empty()) peaks.back() = std::max(peaks.back(), peak);
    previous_roll = std::abs(roll) > 1e-9 ? roll : 0.0;
  }
  ASSERT_GE(peaks.size(), 8U);
  for (const double reached : peaks) EXPECT_GE(reached, 0.95 * limit);
}

TEST_P(CourseSweep, TurnsAreCoordinatedWithinTheBankLimit) {
  double largest_rad = 0.0;
  for (const AircraftState& state : states_) {
    const double roll = attitude(state).roll_rad;
    largest_rad = larger_error(largest_rad, std::abs(roll));
    // On flat ground the heading's rate is the vertical part of the angular rate.
    const Eigen::Vector3d omega_world = state.T_world_body.rotation * state.omega_body_rad_s;
    ASSERT_NEAR(-omega_world.z(), 9.80665 * std::tan(roll) / parameters_.airspeed_m_s, 1e-9);
    const Eigen::Vector3d nose = state.T_world_body.rotation * Eigen::Vector3d::UnitX();
    ASSERT_LT((nose * state.airspeed_m_s - state.v_body_world_m_s).norm(), 1e-9);
  }
  const double expected_rad =
      std::min(parameters_.bank_max_rad,
               std::atan(std::pow(parameters_.airspeed_m_s, 2) / (9.80665 * kTurnRadiusMinM)));
  EXPECT_NEAR(largest_rad, expected_rad, 1e-9);
}

TEST_P(CourseSweep, RollAccelerationHasNoSteps) {
  const double dt_s = 0.01;
  const double limit = parameters_.roll_rate_max_rad_s;
  double largest_change = 0.0;
  double before = 0.0;
  for (std::size_t i = 1; i < states_.size(); ++i) {
    const double acceleration =
        (states_[i].omega_body_rad_s.x() - states_[i - 1].omega_body_rad_s.x()) / dt_s;
    largest_change = larger_error(largest_change, std::abs(acceleration - before));
    before = acceleration;
  }
  // Raised cosine over T: |d2 rate / dt2| <= rate / 2 (pi / T)^2, twice at a joint of two ramps.
  const double bank_rad = 0.38;                           // the least of the sweep, at 10 m/s
  const double ramp_s = std::min(0.5, bank_rad / limit);  // shortest when rolling in from level
  EXPECT_LT(largest_change, limit * std::pow(kPi / ramp_s, 2) * dt_s);
}

INSTANTIATE_TEST_SUITE_P(
    Paper,
    CourseSweep,
    ::testing::Values(
        Case{10, 25}, Case{10, 45}, Case{10, 65}, Case{25, 25}, Case{25, 45}, Case{25, 65}),
    [](const auto& instance) {
      return std::to_string(static_cast<int>(instance.param.airspeed_m_s)) + "ms" +
             std::to_string(static_cast<int>(instance.param.roll_rate_deg_s)) + "degs";
    });

/// Long hills with bumps and a step on them.
class Hills final : public HeightQuery {
 public:
  [[nodiscard]] double ground_up_m(double east_m, double north_m) const override {
    const double hill = 15.0 * std::sin(2.0 * kPi * north_m / 1000.0 + east_m / 400.0);
    const double bump = 2.0 * std::sin(2.0 * kPi * north_m / 31.0);
    const double step = north_m < -600.0 ? 8.0 : 0.0;
    return 120.0 + hill + bump + step;
  }
};

TEST(Course, FollowsHillsSmoothlyAndIgnoresBumps) {
  CourseParameters parameters;
  const auto ground = std::make_shared<Hills>();
  const auto flight = fly(parameters, ground);
  ASSERT_NE(flight, nullptr);
  for (const AircraftState& state : sampled(*flight)) {
    const Eigen::Vector3d p = state.T_world_body.translation;
    // 2 m of bump, half of the 8 m step, 3 % of 15 m of hill.
    ASSERT_NEAR(p.z() - ground->ground_up_m(p.x(), p.y()), 300.0, 7.0) << state.t_ns;
    const double climb_rad = std::asin(state.v_body_world_m_s.z() / state.airspeed_m_s);
    ASSERT_LE(std::abs(climb_rad), kClimbMaxRad + 1e-9);
    ASSERT_NEAR(attitude(state).pitch_rad, climb_rad, 1e-9);
  }
}

TEST(Course, ClimbsNoSteeperThanItsLimitOverACliff) {
  class Cliff final : public HeightQuery {
   public:
    [[nodiscard]] double ground_up_m(double, double north_m) const override {
      return north_m < -500.0 ? 120.0 : 0.0;
    }
  };
  const auto flight = fly({}, std::make_shared<Cliff>());
  ASSERT_NE(flight, nullptr);
  double steepest_rad = 0.0;
  for (const AircraftState& state : sampled(*flight)) {
    steepest_rad = std::max(steepest_rad, std::abs(attitude(state).pitch_rad));
  }
  EXPECT_LE(steepest_rad, kClimbMaxRad * (1.0 + 1e-6));
  EXPECT_GT(steepest_rad, 0.5 * kClimbMaxRad);
}

/// Central differences of the pose against the rates that the flight claims, at odd times, so
/// that nodes and joints of every kind fall between the three points.
TEST(Course, RatesAreTheDerivativesOfThePose) {
  CourseParameters parameters;
  parameters.roll_rate_max_rad_s = rad_from_deg(65.0);
  const auto flight = fly(parameters, std::make_shared<Hills>());
  ASSERT_NE(flight, nullptr);
  constexpr std::int64_t kStepNs = 1'000'000;
  for (std::int64_t t_ns = kStepNs; t_ns < *flight->duration_ns() - kStepNs; t_ns += 7'654'321) {
    const Pose before = flight->state_at(t_ns - kStepNs)->value().T_world_body;
    const AircraftState state = flight->state_at(t_ns).value().value();
    const Pose after = flight->state_at(t_ns + kStepNs)->value().T_world_body;
    const Eigen::Vector3d velocity = (after.translation - before.translation) / 2e-3;
    // Third derivatives: V (g/V)^2 ~ 4 m/s3 over 6 * 1e-6 s2, and rounding 1e-13 / 1e-3.
    ASSERT_LT((velocity - state.v_body_world_m_s).norm(), 1e-5) << t_ns;
    const Eigen::Quaterniond turned = before.rotation.conjugate() * after.rotation;
    const Eigen::Vector3d omega = 2.0 * turned.vec() * (turned.w() < 0 ? -1.0 : 1.0) / 2e-3;
    // Second derivative of a raised cosine's rate: 1.13 / 2 (pi / 0.5)^2 = 22 rad/s3.
    ASSERT_LT((omega - state.omega_body_rad_s).norm(), 2e-5) << t_ns;
  }
}

/// Third differences at 1 kHz see a jitter of the attitude of far less than a microradian.
TEST(Course, AttitudeHasNoJitter) {
  const auto flight = fly({}, std::make_shared<Hills>());
  ASSERT_NE(flight, nullptr);
  std::vector<Eigen::Vector3d> turns;  // from one millisecond to the next
  Eigen::Quaterniond before = flight->state_at(0)->value().T_world_body.rotation;
  for (std::int64_t t_ns = 1'000'000; t_ns < 70'000'000'000; t_ns += 1'000'000) {
    const Eigen::Quaterniond now = flight->state_at(t_ns)->value().T_world_body.rotation;
    const Eigen::Quaterniond step = before.conjugate() * now;
    turns.emplace_back(2.0 * step.vec() * (step.w() < 0 ? -1.0 : 1.0));
    before = now;
  }
  double largest_rad = 0.0;
  for (std::size_t i = 2; i < turns.size(); ++i) {
    largest_rad = larger_error(largest_rad, (turns[i] - 2.0 * turns[i - 1] + turns[i - 2]).norm());
  }
  // The motion's own: |d3 angle| <= 0.785 / 2 (pi / 0.5)^2 rad/s3 * (1e-3 s)^3 = 1.6e-8 rad.
  EXPECT_LT(largest_rad, 3e-8);
}

TEST(Course, IsTheSameFlightEachTime) {
  const auto a = fly({}, std::make_shared<Hills>());
  const auto b = fly({}, std::make_shared<Hills>());
  for (std::int64_t t_ns = 0; t_ns < *a->duration_ns(); t_ns += 333'333'333) {
    EXPECT_EQ(a->state_at(t_ns)->value().T_world_body.matrix(),
              b->state_at(t_ns)->value().T_world_body.matrix());
  }
}

TEST(Course, StartsAndHeadsWhereTold) {
  CourseParameters parameters;
  parameters.start_east_m = 250.0;
  parameters.start_north_m = -40.0;
  parameters.heading_rad = rad_from_deg(90.0);
  const auto flight = fly(parameters);
  const AircraftState start = flight->state_at(0).value().value();
  EXPECT_TRUE(start.T_world_body.translation.isApprox(Eigen::Vector3d(250, -40, 400)));
  EXPECT_TRUE(start.v_body_world_m_s.isApprox(Eigen::Vector3d(25, 0, 0)));
  EXPECT_EQ(flight->description(), "course: 25 m/s, 45 deg/s, 300 m above the ground");
}

TEST(Course, KnowsNothingOutsideItsTimes) {
  const auto flight = fly({});
  EXPECT_EQ(flight->state_at(-1).error().code, ErrorCode::kInvalidArgument);
  EXPECT_TRUE(flight->state_at(*flight->duration_ns()).value().has_value());
  EXPECT_FALSE(flight->state_at(*flight->duration_ns() + 1).value().has_value());
}

TEST(Course, FliesAtTheLimitsOfItsParameters) {
  for (const double airspeed : {5.0, 80.0}) {
    for (const double rate : {0.01, 3.5}) {
      for (const double bank : {0.01, 1.2}) {
        for (const double leg : {0.0, 1100.0, 3300.0}) {
          CourseParameters parameters;
          parameters.airspeed_m_s = airspeed;
          parameters.roll_rate_max_rad_s = rate;
          parameters.bank_max_rad = bank;
          parameters.leg_length_m = leg;
          const auto flight = fly(parameters);
          ASSERT_NE(flight, nullptr);
          EXPECT_NEAR(s_from_ns(*flight->duration_ns()) * airspeed, 3300.0, 1e-3);
          for (std::int64_t t_ns = 0; t_ns < *flight->duration_ns(); t_ns += 997'000'000) {
            const AircraftState state = flight->state_at(t_ns).value().value();
            ASSERT_TRUE(state.T_world_body.matrix().allFinite());
            ASSERT_LE(std::abs(attitude(state).roll_rad), bank + 1e-9);
          }
        }
      }
    }
  }
}

TEST(Course, NamesFieldValueAndLimitInDegrees) {
  const auto message = [](const auto& change) {
    CourseParameters parameters;
    change(parameters);
    const auto flight = fly_course(parameters, std::make_shared<FlatGround>(0.0));
    EXPECT_FALSE(flight.ok());
    EXPECT_EQ(flight.error().code, ErrorCode::kInvalidArgument);
    return flight.error().message;
  };
  EXPECT_EQ(message([](auto& p) { p.airspeed_m_s = 3; }),
            "course: airspeed_m_s = 3: must be in [5, 80]");
  EXPECT_EQ(message([](auto& p) { p.bank_max_rad = rad_from_deg(75); }),
            "course: bank_max_deg = 75: must be in (0, 68.7549]");
  EXPECT_EQ(message([](auto& p) { p.roll_rate_max_rad_s = 0; }),
            "course: roll_rate_max_deg_s = 0: must be in (0, 200.535]");
  EXPECT_EQ(message([](auto& p) { p.height_agl_m = 10; }),
            "course: height_agl_m = 10: must be in [20, 3000]");
  EXPECT_EQ(message([](auto& p) { p.leg_length_m = 4000; }),
            "course: leg_length_m = 4000: must be in [0, 3300]");
  EXPECT_EQ(message([](auto& p) { p.heading_rad = NAN; }),
            "course: heading_deg = nan: must be in [-360, 360]");
  EXPECT_THAT(fly_course({}, nullptr).error().message, HasSubstr("ground"));
}

TEST(Course, RefusesGroundThatItCannotFlyOver) {
  class Wall final : public HeightQuery {
   public:
    [[nodiscard]] double ground_up_m(double, double north_m) const override {
      return north_m < -500.0 && north_m > -560.0 ? 290.0 : 0.0;
    }
  };
  class Hole final : public HeightQuery {
   public:
    [[nodiscard]] double ground_up_m(double, double north_m) const override {
      return north_m < -500.0 ? NAN : 0.0;
    }
  };
  EXPECT_THAT(fly_course({}, std::make_shared<Wall>()).error().message,
              HasSubstr("height_agl_m = 300: the course would pass"));
  EXPECT_THAT(fly_course({}, std::make_shared<Hole>()).error().message, HasSubstr("not finite"));
}

}  // namespace
}  // namespace overfly::flight
