#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/vo_bridges/adapters/adapter_run.hpp"
#include "tests/vo_bridges/vo_port_contract.hpp"

namespace overfly::testing {
namespace {

using ::testing::_;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::Pair;

class Adapter : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Upstream, Adapter, ::testing::Values("orbslam2", "dso", "svo"));

TEST_P(Adapter, AnswersWithTheCameraInItsMapNotTheMapInTheCamera) {
  AdapterRun run(GetParam());
  run.track_plain(3);
  for (int i = 3; i < 12; ++i) {
    const VoEstimate answer = run.track();
    ASSERT_EQ(answer.sample.state, TrackingState::kTracking) << i;
    const double t_s = 1e-9 * static_cast<double>(answer.sample.t_ns);
    const Pose& pose = answer.sample.T_vo_camera;
    EXPECT_LT((pose.translation - standins::position_at(t_s)).norm(), 1e-5) << i;
    EXPECT_LT(pose.rotation.angularDistance(standins::orientation_at(t_s)), 1e-5) << i;
    ASSERT_TRUE(answer.sample.scene_depth.has_value());
    EXPECT_NEAR(*answer.sample.scene_depth, standins::kDepth, 1e-5);
  }
}

TEST_P(Adapter, SaysThatItStartsUntilItHasAPose) {
  AdapterRun run(GetParam());
  EXPECT_EQ(run.track().sample.state, TrackingState::kInitialising);
}

TEST_P(Adapter, SaysLostWhileItSeesNothing) {
  AdapterRun run(GetParam());
  run.track_plain(20);
  EXPECT_EQ(run.track(standins::kDark).sample.state, TrackingState::kLost);
}

TEST_P(Adapter, CountsAMapThatIsThrownAway) {
  AdapterRun run(GetParam());
  EXPECT_EQ(run.track_plain(8).sample.map_id, 0);
  run.track(standins::kThrowMapAway);
  EXPECT_EQ(run.track().sample.state, TrackingState::kInitialising);
  const EstimateSample again = run.track_plain(4).sample;
  EXPECT_EQ(again.state, TrackingState::kTracking);
  EXPECT_EQ(again.map_id, 1);
}

TEST_P(Adapter, IsNotAResetWhenTheFirstStartFails) {
  AdapterRun run(GetParam());
  run.track();
  run.track(standins::kDark);
  const EstimateSample started = run.track_plain(8).sample;
  EXPECT_EQ(started.state, TrackingState::kTracking);
  EXPECT_EQ(started.map_id, 0) << "no pose was ever given in the map that failed";
}

TEST_P(Adapter, IsGoneForGoodWhenTheLibraryExits) {
  AdapterRun run(GetParam());
  run.track_plain(5);
  const Result<VoEstimate> answer = run.try_track(standins::kExit);
  ASSERT_FALSE(answer.ok());
  EXPECT_EQ(answer.error().code, ErrorCode::kInternal);
}

TEST_P(Adapter, IsGoneForGoodWhenAnAssertionFails) {
  AdapterRun run(GetParam());
  run.track_plain(5);
  const Result<VoEstimate> answer = run.try_track(standins::kAbort);
  ASSERT_FALSE(answer.ok());
  EXPECT_EQ(answer.error().code, ErrorCode::kInternal);
}

TEST_P(Adapter, RefusesAParameterThatUpstreamHasNot) {
  EXPECT_THAT(refusal(GetParam(), {{"minGradHistogram", 5.0}}),
              HasSubstr("parameter minGradHistogram: not one of preset"));
}

TEST_P(Adapter, RefusesAPresetThatIsNotOne) {
  EXPECT_THAT(refusal(GetParam(), {{"preset", std::string("fastest")}}),
              HasSubstr("parameter preset = 'fastest': must be one of "));
}

TEST_P(Adapter, TellsNoParameterBeforeItIsKnown) {
  AdapterRun run(GetParam());
  const auto at_start = run.port().effective_parameters();
  EXPECT_THAT(at_start, Not(Contains(Pair(_, "auto"))));
  VoFrame first = ordered_frame(0);
  first.image = nullptr;
  ASSERT_TRUE(run.port().prepare(first).ok());
  const auto prepared = run.port().effective_parameters();
  EXPECT_GT(prepared.size(), at_start.size());
  run.track_plain(3);
  EXPECT_EQ(run.port().effective_parameters(), prepared) << "nothing changes in flight";
}

TEST_P(Adapter, DrawsAnImageOfTheFramesSizeAndItsMap) {
  AdapterRun run(GetParam());
  run.port().set_debug(true);
  const VoEstimate answer = run.track_plain(6);
  ASSERT_TRUE(answer.debug_image.has_value());
  EXPECT_EQ(answer.debug_image->width_px, kWidthPx);
  EXPECT_EQ(answer.debug_image->height_px, kHeightPx);
  EXPECT_EQ(answer.map_points_vo.size(), 41U);
}

struct PresetCase {
  std::string adapter;
  std::string preset;
  std::string parameter;
  std::string value;
};

void PrintTo(const PresetCase& preset, std::ostream* out) { *out << preset.preset; }

class AdapterPreset : public ::testing::TestWithParam<PresetCase> {};

INSTANTIATE_TEST_SUITE_P(
    Published,
    AdapterPreset,
    ::testing::Values(PresetCase{"orbslam2", "minThFAST_7", "ORBextractor.minThFAST", "7"},
                      PresetCase{"orbslam2", "minThFAST_2", "ORBextractor.minThFAST", "2"},
                      PresetCase{"dso", "setting_minGradHistAdd_7", "setting_minGradHistAdd", "7"},
                      PresetCase{"dso", "setting_minGradHistAdd_5", "setting_minGradHistAdd", "5"},
                      PresetCase{"svo", "triangMinCornerScore_20", "triangMinCornerScore", "20"},
                      PresetCase{"svo", "triangMinCornerScore_7", "triangMinCornerScore", "7"},
                      PresetCase{"svo", "triangMinCornerScore_2", "triangMinCornerScore", "2"},
                      PresetCase{"svo", "kfSelectMinDist_12", "kfSelectMinDist", "0.12"},
                      PresetCase{"svo", "kfSelectMinDist_5", "kfSelectMinDist", "0.05"}));

TEST_P(AdapterPreset, IsInForceInTheRunningSystem) {
  AdapterRun run(GetParam().adapter, {{"preset", GetParam().preset}});
  run.track();
  EXPECT_EQ(run.port().effective_parameters().at(GetParam().parameter), GetParam().value);
  EXPECT_EQ(run.port().effective_parameters().at("preset"), GetParam().preset);
}

TEST_P(AdapterPreset, GivesWayToAParameterByName) {
  const VoParameters wanted = {{"preset", GetParam().preset}, {GetParam().parameter, 3.0}};
  AdapterRun run(GetParam().adapter, wanted);
  run.track();
  EXPECT_EQ(run.port().effective_parameters().at(GetParam().parameter), "3");
}

/// What the stand-ins do where this variable is set: they take the value and go on with their own.
TEST(AdapterParameters, FailTheRunWhenTheRunningSystemHasOthersInForce) {
  const Environment stubborn("STANDIN_KEEPS_ITS_DEFAULT");
  EXPECT_THAT(refusal("orbslam2", {{"preset", std::string("minThFAST_2")}}),
              HasSubstr("ORBextractor.minThFAST = 2 was requested, but the running system has 7"));
  EXPECT_THAT(refusal("dso", {{"setting_minGradHistAdd", 5.0}}),
              HasSubstr("setting_minGradHistAdd = 5 was requested, but the running system has 7"));
  EXPECT_THAT(refusal("svo", {{"triangMinCornerScore", 2.0}}),
              HasSubstr("triangMinCornerScore = 2 was requested, but the running system has 20"));
}

std::vector<VoFrame> contract_frames() { return plain_frames(12, kWidthPx, kHeightPx); }

VoPortCase contract_case(const std::string& name) {
  return {name, [name] { return std::move(start_adapter(name)).value(); }, contract_frames, 8};
}

INSTANTIATE_TEST_SUITE_P(OrbSlam2Adapter,
                         VoPortContract,
                         ::testing::Values(contract_case("orbslam2")));
INSTANTIATE_TEST_SUITE_P(DsoAdapter, VoPortContract, ::testing::Values(contract_case("dso")));
INSTANTIATE_TEST_SUITE_P(SvoAdapter, VoPortContract, ::testing::Values(contract_case("svo")));

}  // namespace
}  // namespace overfly::testing
