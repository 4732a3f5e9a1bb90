// A flight recorded with noise, jumps and steps becomes one smooth motion close to the truth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tests/flight/smoothing/sampled_flight.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::smoothing {
namespace {

using overfly::testing::larger_error;
using ::testing::HasSubstr;
using testing::Recorder;
using testing::Recording;
using testing::TrueCourse;

SmoothedMotion smoothed(const Recording& recording, const SmoothingOptions& options = {}) {
  Result<SmoothedMotion> result = smooth_motion(recording.positions, recording.attitudes, options);
  EXPECT_TRUE(result.ok()) << (result ? "" : result.error().message);
  return std::move(result).value();
}

void shift_positions(Recording& recording,
                     double from_s,
                     double to_s,
                     const Eigen::Vector3d& by_m) {
  for (PositionSample& sample : recording.positions) {
    if (sample.t_s >= from_s && sample.t_s < to_s) sample.p_world_m += by_m;
  }
}

void yaw_attitudes(Recording& recording, double from_s, double to_s, double by_rad) {
  for (AttitudeSample& sample : recording.attitudes) {
    if (sample.t_s < from_s || sample.t_s >= to_s) continue;
    sample.R_ned_body = rotation_from_vector({0, 0, by_rad}) * sample.R_ned_body;
  }
}

/// Erratic jumps of both kinds, as logs of small aircraft have them.
void make_erratic(Recording& recording, std::uint64_t seed) {
  NormalNoise noise(seed);
  for (const double t_s : {10.0, 33.3, 55.0, 71.2, 90.0, 118.0}) {
    const double north_m = 60.0 * noise.draw();
    const Eigen::Vector3d by_m(60.0 * noise.draw(), north_m, 25.0);
    shift_positions(recording, t_s, t_s + 0.1 + 0.3 * std::abs(noise.draw()), by_m);
  }
  for (PositionSample& sample : recording.positions) {  // a burst longer than a second
    if (sample.t_s < 80.0 || sample.t_s >= 81.2) continue;
    sample.p_world_m += 40.0 * testing::noise_vector(noise);
  }
  shift_positions(recording, 40.0, 52.0, {12.0, -7.0, 4.0});  // a step, there and back
  yaw_attitudes(recording, 20.0, 20.1, rad_from_deg(40.0));
  yaw_attitudes(recording, 99.0, 99.06, rad_from_deg(-170.0));
  yaw_attitudes(recording, 60.0, 70.0, rad_from_deg(25.0));
}

std::size_t count_of(const SmoothedMotion& result, JumpKind kind) {
  std::size_t count = 0;
  for (const Jump& jump : result.jumps) count += jump.kind == kind ? 1 : 0;
  return count;
}

TEST(SmoothMotion, IsCloseToTheTruthOfANoisyFlight) {
  const SmoothedMotion result = smoothed(testing::record({}));
  EXPECT_TRUE(result.jumps.empty());
  const testing::Distance off = testing::distance(result.motion, TrueCourse());
  // Less than the noise of a single sample, 0.41 m and 0.35 deg in three axes.
  EXPECT_LT(off.position_m, 0.25);
  EXPECT_LT(off.attitude_rad, rad_from_deg(0.2));
  EXPECT_LT(off.worst_position_m, 1.0);
  EXPECT_NEAR(result.positions.rms, 0.41, 0.1);
  // Rates are right too: 45 deg/s in the reversals.
  TrueCourse truth;
  double sum = 0.0;
  int count = 0;
  for (double t_s = 1.0; t_s < 128.0; t_s += 0.1, ++count) {
    sum += (result.motion.at(t_s).v_world_m_s - truth(t_s).v_world_m_s).squaredNorm();
  }
  EXPECT_LT(std::sqrt(sum / count), 0.6);
}

class ErraticFlight : public ::testing::TestWithParam<std::uint64_t> {};
// Seeds 1 to 20 give 0.05 to 0.18 m and 0.01 to 0.17 deg from the flight without jumps.
INSTANTIATE_TEST_SUITE_P(Seeds, ErraticFlight, ::testing::Values(7, 10, 14));

TEST_P(ErraticFlight, IsSmoothedAsIfItHadNoJumps) {
  Recorder recorder;
  recorder.seed = GetParam();
  const Recording clean = testing::record(recorder);
  Recording erratic = clean;
  make_erratic(erratic, 100 + GetParam());
  const SmoothedMotion expected = smoothed(clean);
  const SmoothedMotion result = smoothed(erratic);
  const testing::Distance off =
      testing::distance(result.motion, [&](double t_s) { return expected.motion.at(t_s); });
  EXPECT_LT(off.position_m, 0.3);
  EXPECT_LT(off.attitude_rad, rad_from_deg(0.2));
  const testing::Distance from_truth = testing::distance(result.motion, TrueCourse());
  EXPECT_LT(from_truth.position_m, 0.35);
  EXPECT_LT(from_truth.attitude_rad, rad_from_deg(0.25));
  EXPECT_LT(from_truth.worst_position_m, 3.0);

  EXPECT_EQ(count_of(result, JumpKind::kPositionOutliers), 7U);
  EXPECT_EQ(count_of(result, JumpKind::kPositionStep), 2U);
  EXPECT_EQ(count_of(result, JumpKind::kAttitudeOutliers), 2U);
  EXPECT_EQ(count_of(result, JumpKind::kYawStep), 2U);
  EXPECT_EQ(result.positions.shifted, 120U);
  EXPECT_EQ(result.attitudes.shifted, 500U);
  EXPECT_EQ(result.attitudes.left_out, 8U);
  for (const Jump& jump : result.jumps) {
    if (jump.kind == JumpKind::kPositionStep) {
      EXPECT_NEAR(jump.size, 14.46, 1.5);
    }
    if (jump.kind == JumpKind::kYawStep) {
      EXPECT_NEAR(deg_from_rad(jump.size), 25.0, 1.0);
    }
  }
  EXPECT_NEAR(result.jumps.front().t_s, 10.0, 1e-9);
}

TEST(SmoothMotion, TakesTheLongerSideOfAStepThatStays) {
  Recording recording = testing::record({});
  shift_positions(recording, 100.0, 200.0, {0.0, 9.0, -6.0});
  yaw_attitudes(recording, 30.0, 200.0, rad_from_deg(12.0));
  const SmoothedMotion result = smoothed(recording);
  ASSERT_EQ(result.jumps.size(), 2U);
  EXPECT_EQ(result.jumps[0].kind, JumpKind::kYawStep);
  EXPECT_NEAR(result.jumps[0].t_s, 30.0, 1e-9);
  EXPECT_EQ(result.jumps[1].kind, JumpKind::kPositionStep);
  EXPECT_NEAR(result.jumps[1].size, std::hypot(9.0, 6.0), 1.0);
  const auto moved = [truth = TrueCourse()](double t_s) {
    MotionState state = truth(t_s);
    state.R_ned_body = rotation_from_vector({0, 0, rad_from_deg(12.0)}) * state.R_ned_body;
    return state;
  };
  const testing::Distance off = testing::distance(result.motion, moved);
  // The step itself is known only as well as the positions on both of its sides.
  EXPECT_LT(off.position_m, 0.5);
  EXPECT_LT(off.attitude_rad, rad_from_deg(0.4));
  // What remains continues smoothly: no sample of 31 Hz moves by more than the speed allows.
  for (double t_s = 95.0; t_s < 105.0; t_s += 0.032) {
    const double step_m =
        (result.motion.at(t_s + 0.032).p_world_m - result.motion.at(t_s).p_world_m).norm();
    EXPECT_LT(step_m, 0.032 * 28.0);
  }
}

TEST(SmoothMotion, FindsTheTimeOffsetOfTheAttitudes) {
  for (const double delay_s : {-0.35, 0.0, 0.12}) {
    Recorder recorder;
    recorder.attitude_delay_s = delay_s;
    const Recording recording = testing::record(recorder);
    SmoothingOptions options;
    options.time_offset_s.reset();
    const SmoothedMotion result = smoothed(recording, options);
    ASSERT_TRUE(result.estimated_offset.has_value());
    EXPECT_NEAR(result.estimated_offset->offset_s, -delay_s, 0.015);
    EXPECT_LT(result.estimated_offset->sigma_s, 0.03);
    const testing::Distance off = testing::distance(result.motion, TrueCourse());
    EXPECT_LT(off.attitude_rad, rad_from_deg(0.4));
  }
}

TEST(SmoothMotion, RefusesToEstimateAnOffsetWithoutTurns) {
  Recorder recorder;
  recorder.duration_s = 40.0;  // the first leg is straight
  const Recording recording = testing::record(recorder);
  SmoothingOptions options;
  options.time_offset_s.reset();
  const auto result = smooth_motion(recording.positions, recording.attitudes, options);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(result.error().message, HasSubstr("time offset"));
}

TEST(SmoothMotion, RemovesTheTiltOfTheBoard) {
  Recording recording = testing::record({});
  const Eigen::Quaterniond R_body_board = rotation_from_vector({0.1, -0.05, 0.2});
  for (AttitudeSample& sample : recording.attitudes)
    sample.R_ned_body = sample.R_ned_body * R_body_board;
  SmoothingOptions options;
  options.R_logged_body = R_body_board.conjugate();
  const SmoothedMotion result = smoothed(recording, options);
  EXPECT_LT(testing::distance(result.motion, TrueCourse()).attitude_rad, rad_from_deg(0.2));
  TrueCourse truth;
  double worst = 0.0;
  for (double t_s = 46.0; t_s < 60.0; t_s += 0.5) {
    worst = larger_error(
        worst, (result.motion.at(t_s).omega_body_rad_s - truth(t_s).omega_body_rad_s).norm());
  }
  EXPECT_LT(worst, 0.2);
}

TEST(SmoothMotion, BridgesGaps) {
  Recording recording = testing::record({});
  std::erase_if(recording.positions, [](const PositionSample& sample) {
    return sample.t_s > 60.05 && sample.t_s < 61.05;
  });
  const SmoothedMotion result = smoothed(recording);
  EXPECT_NEAR(result.positions.longest_gap_s, 1.1, 1e-9);
  EXPECT_LT(testing::distance(result.motion, TrueCourse()).position_m, 0.3);
}

TEST(SmoothMotion, IsAFunctionOfItsInput) {
  Recording recording = testing::record({});
  make_erratic(recording, 11);
  const SmoothedMotion first = smoothed(recording);
  const SmoothedMotion second = smoothed(recording);
  ASSERT_EQ(first.motion.position.control_m.size(), second.motion.position.control_m.size());
  EXPECT_EQ(std::memcmp(first.motion.position.control_m.data(),
                        second.motion.position.control_m.data(),
                        first.motion.position.control_m.size() * sizeof(Eigen::Vector3d)),
            0);
  EXPECT_EQ(std::memcmp(first.motion.attitude.control.data(),
                        second.motion.attitude.control.data(),
                        first.motion.attitude.control.size() * sizeof(Eigen::Quaterniond)),
            0);
}

/// Gaps up to half an hour, rates from 0.5 Hz to 1 kHz, positions up to 10^7 m apart, any attitude.
Recording hostile_recording(std::uint64_t seed) {
  NormalNoise noise(seed);
  Recording recording;
  const double spread_m = std::pow(10.0, static_cast<double>(seed % 8));
  const double turn_rad = std::pow(10.0, -static_cast<double>(seed % 4));
  double t_s = 0.0;
  for (int i = 0; i < 150; ++i) {
    t_s += std::abs(noise.draw()) < 0.02 ? 1000.0 : 0.001 + 0.2 * std::abs(noise.draw());
    const Eigen::Vector3d p = testing::noise_vector(noise);
    const bool jumps = i % 7 == 0;
    recording.positions.push_back({t_s, (jumps ? spread_m : 1e-3 * spread_m) * p});
    recording.attitudes.push_back(
        {t_s, rotation_from_vector(turn_rad * Eigen::Vector3d(p.y(), p.z(), jumps ? 3.0 : 0.1))});
  }
  return recording;
}

TEST(SmoothMotion, IsFiniteForAnySamplesThatItAccepts) {
  int accepted = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const Recording recording = hostile_recording(seed);
    const auto result = smooth_motion(recording.positions, recording.attitudes, {});
    if (!result) {
      EXPECT_EQ(result.error().code, ErrorCode::kUnreadable) << result.error().message;
      continue;
    }
    ++accepted;
    const SmoothMotion& motion = result->motion;
    const double step_s = (motion.end_s - motion.begin_s) / 500.0;
    for (int i = 0; i <= 500; ++i) {
      const MotionState state = motion.at(motion.begin_s + i * step_s);
      ASSERT_TRUE(state.p_world_m.allFinite() && state.v_world_m_s.allFinite()) << seed;
      ASSERT_TRUE(state.R_ned_body.coeffs().allFinite()) << seed;
      ASSERT_TRUE(state.omega_body_rad_s.allFinite()) << seed;
    }
  }
  EXPECT_GE(accepted, 3);
}

TEST(SmoothMotion, ReportsItsProgress) {
  const Recording recording = testing::record({});
  std::vector<std::string> steps;
  double last = 0.0;
  const auto result = smooth_motion(recording.positions,
                                    recording.attitudes,
                                    {},
                                    nullptr,
                                    [&](const std::string& step, double share) {
                                      const bool begins = steps.empty() || steps.back() != step;
                                      EXPECT_TRUE(begins || share > last || share == 0.0);
                                      EXPECT_LT(share, 1.0);
                                      if (begins) steps.push_back(step);
                                      last = share;
                                    });
  ASSERT_TRUE(result.ok()) << result.error().message;
  EXPECT_EQ(steps, (std::vector<std::string>{"positions", "attitudes"}));
}

TEST(SmoothMotion, RejectsWhatIsNoFlight) {
  const Recording recording = testing::record({});
  const auto error_of = [](const Recording& samples, const SmoothingOptions& options = {}) {
    const auto result = smooth_motion(samples.positions, samples.attitudes, options);
    return result ? std::string() : result.error().message;
  };
  Recording few = recording;
  few.positions.resize(4);
  EXPECT_THAT(error_of(few), HasSubstr("4 positions: must be at least 5"));
  Recording apart = recording;
  apart.positions.back().t_s = 1e9;
  EXPECT_THAT(error_of(apart), HasSubstr("must be at most 86400 s"));
  Recording late = recording;
  for (AttitudeSample& sample : late.attitudes) sample.t_s += 500.0;
  EXPECT_THAT(error_of(late), HasSubstr("less than 1 s in common"));
  Recording random = recording;
  NormalNoise noise(5);
  for (PositionSample& sample : random.positions) {
    sample.p_world_m += 300.0 * testing::noise_vector(noise);
  }
  EXPECT_THAT(error_of(random), HasSubstr("m: must be at most 50 m"));
  for (AttitudeSample& sample : late.attitudes) {
    sample.R_ned_body =
        rotation_from_vector({2 * noise.draw(), 2 * noise.draw(), 2 * noise.draw()});
  }
  EXPECT_THAT(error_of(late), HasSubstr("deg: must be at most 20 deg"));
  SmoothingOptions options;
  options.jump_m = std::nan("");
  EXPECT_THAT(error_of(recording, options), HasSubstr("jump_m = nan: must be in [0.001, 1000]"));
  options = {};
  options.time_offset_s = 3.0;
  EXPECT_THAT(error_of(recording, options), HasSubstr("time_offset_s = 3: must be in [-2, 2]"));
  const std::atomic<bool> cancelled = true;
  const auto result = smooth_motion(recording.positions, recording.attitudes, {}, &cancelled);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace overfly::flight::smoothing
