#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/evaluation/flights.hpp"

namespace overfly::evaluation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Trajectory line(int count, std::int64_t step_ns, double speed_m_s) {
  Trajectory truth;
  for (int i = 0; i < count; ++i) {
    const double t_s = s_from_ns(i * step_ns);
    EXPECT_TRUE(
        truth.append({i * step_ns, {Eigen::Quaterniond::Identity(), {speed_m_s * t_s, 0, 0}}})
            .ok());
  }
  return truth;
}

EstimateTrack stamped_at(const std::vector<std::int64_t>& times_ns) {
  EstimateTrack track;
  for (const std::int64_t t_ns : times_ns) {
    EstimateSample sample;
    sample.frame = static_cast<std::int64_t>(track.samples.size());
    sample.t_ns = t_ns;
    sample.state = TrackingState::kTracking;
    track.samples.push_back(sample);
  }
  return track;
}

TEST(Association, InterpolatesTheTruthAtTheEstimatesTime) {
  const Trajectory truth = line(11, 100'000'000, 25.0);
  const auto matches = associate(truth, stamped_at({0, 132'000'000, 999'999'999}), {});
  ASSERT_TRUE(matches.ok());
  ASSERT_EQ(matches->size(), 3U);
  EXPECT_NEAR((*matches)[1].T_world_camera.translation.x(), 25.0 * 0.132, 1e-12);
  EXPECT_EQ((*matches)[1].t_ns, 132'000'000);
}

/// At 25 m/s and 10 ms the nearest pose is up to 0.25 m off: what evo's default hides.
TEST(Association, NearestTakesTheStampAsItIsWithinTheLimit) {
  const Trajectory truth = line(11, 100'000'000, 25.0);
  Options options;
  options.association = Association::kNearest;
  const auto matches =
      associate(truth, stamped_at({8'000'000, 110'000'000, 195'000'000, 250'000'000}), options);
  ASSERT_TRUE(matches.ok());
  ASSERT_EQ(matches->size(), 3U);  // 250 ms is 50 ms from its neighbours
  EXPECT_EQ((*matches)[0].T_world_camera.translation.x(), 0.0);
  EXPECT_EQ((*matches)[1].T_world_camera.translation.x(), 2.5);
  EXPECT_EQ((*matches)[2].T_world_camera.translation.x(), 5.0);
  EXPECT_EQ((*matches)[2].t_ns, 195'000'000);
}

TEST(Association, NearestUsesEachTruthPoseOnce) {
  const Trajectory truth = line(11, 100'000'000, 25.0);
  Options options;
  options.association = Association::kNearest;
  options.max_time_difference_ns = 60'000'000;
  const auto matches =
      associate(truth, stamped_at({70'000'000, 101'000'000, 130'000'000, 190'000'000}), options);
  ASSERT_TRUE(matches.ok());
  ASSERT_EQ(matches->size(), 2U);
  EXPECT_EQ((*matches)[0].t_ns, 101'000'000);
  EXPECT_EQ((*matches)[1].t_ns, 190'000'000);
}

TEST(Association, IndexIgnoresTimes) {
  const Trajectory truth = line(3, kNsPerS, 10.0);
  Options options;
  options.association = Association::kIndex;
  const auto matches = associate(truth, stamped_at({5, 6, 7, 8}), options);
  ASSERT_TRUE(matches.ok());
  ASSERT_EQ(matches->size(), 3U);
  EXPECT_EQ((*matches)[2].T_world_camera.translation.x(), 20.0);
  EXPECT_EQ((*matches)[2].t_ns, 2 * kNsPerS);
}

TEST(Association, LeavesOutWhatTheTruthDoesNotCover) {
  const Trajectory truth = line(11, 100'000'000, 25.0);
  const auto matches = associate(truth, stamped_at({-1, 0, 1'000'000'000, 1'000'000'001}), {});
  ASSERT_TRUE(matches.ok());
  EXPECT_EQ(matches->size(), 2U);
}

TEST(Association, SaysBothTimeRangesWhereNothingOverlaps) {
  const Trajectory truth = line(11, 100'000'000, 25.0);
  const auto matches = associate(truth, stamped_at({1'403'636'579'000'000'000}), {});
  ASSERT_FALSE(matches.ok());
  EXPECT_EQ(matches.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(matches.error().message,
              AllOf(HasSubstr("[1403636579.000000, 1403636579.000000] s"),
                    HasSubstr("[0.000000, 1.000000] s")));
  Options nearest;
  nearest.association = Association::kNearest;
  EXPECT_THAT(associate(truth, stamped_at({150'000'000}), nearest).error().message,
              HasSubstr("within 0.010000 s"));
}

TEST(Association, NeedsTrackedFramesAndATruth) {
  const Trajectory truth = line(11, 100'000'000, 25.0);
  EstimateTrack track = stamped_at({0, 100'000'000});
  for (EstimateSample& sample : track.samples) sample.state = TrackingState::kInitialising;
  EXPECT_THAT(associate(truth, track, {}).error().message, HasSubstr("never tracked"));
  EXPECT_THAT(associate({}, stamped_at({0}), {}).error().message, HasSubstr("truth"));
}

TEST(Association, TakesTheMapWithTheMostFrames) {
  const Trajectory truth = line(11, 100'000'000, 25.0);
  EstimateTrack track = stamped_at({0, 100'000'000, 200'000'000, 300'000'000, 400'000'000});
  for (std::size_t i = 2; i < 5; ++i) track.samples[i].map_id = 1;
  const auto matches = associate(truth, track, {});
  ASSERT_TRUE(matches.ok());
  ASSERT_EQ(matches->size(), 3U);
  EXPECT_EQ(matches->front().t_ns, 200'000'000);
}

}  // namespace
}  // namespace overfly::evaluation
