#include "server/estimators/estimator_driver.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace overfly::server {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

/// An estimator of functions.
struct ScriptedPort final : VoPort {
  std::function<Status()> when_prepared = [] { return Status(); };
  std::function<Result<VoEstimate>()> when_tracked = [] { return VoEstimate(); };
  std::optional<ResourceUse> use;
  bool debug = false;

  std::string type() const override { return "scripted"; }
  std::map<std::string, std::string> effective_parameters() const override { return {}; }
  Status prepare(const VoFrame& /*first*/) override { return when_prepared(); }
  Result<VoEstimate> track(const VoFrame& /*frame*/) override { return when_tracked(); }
  void set_debug(bool wanted) override { debug = wanted; }
  std::optional<ResourceUse> resource_use() const override { return use; }
};

VoFrame numbered_frame(std::int64_t index) {
  VoFrame frame;
  frame.index = index;
  frame.t_ns = 1000 * index;
  return frame;
}

TEST(EstimatorDriver, ReportsAFailedPreparationWithTheFirstFrame) {
  ScriptedPort port;
  port.when_prepared = [] { return Error{ErrorCode::kNotFound, "no such camera"}; };
  EstimatorDriver driver(port);
  driver.prepare(numbered_frame(0));
  const auto answer = driver.track(numbered_frame(0), false);
  ASSERT_FALSE(answer.ok());
  EXPECT_EQ(answer.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(answer.error().message, "no such camera");
}

TEST(EstimatorDriver, TurnsAnExceptionIntoAnError) {
  ScriptedPort port;
  port.when_tracked = []() -> Result<VoEstimate> { throw std::runtime_error("thrown"); };
  EstimatorDriver driver(port);
  const auto answer = driver.track(numbered_frame(0), false);
  ASSERT_FALSE(answer.ok());
  EXPECT_EQ(answer.error().code, ErrorCode::kInternal);
  EXPECT_EQ(answer.error().message, "thrown");
}

TEST(EstimatorDriver, GivesAnAnswerTheFramesTimeAndDropsNumbersThatAreNotFinite) {
  ScriptedPort port;
  port.when_tracked = [] {
    VoEstimate estimate;
    estimate.sample.frame = 99;
    estimate.counters = {{"features", 120.0}, {"odd", std::nan("")}};
    estimate.timing_ms = {{"odd", std::numeric_limits<double>::infinity()}};
    return estimate;
  };
  EstimatorDriver driver(port);
  const auto answer = driver.track(numbered_frame(7), true);
  ASSERT_TRUE(answer.ok());
  EXPECT_TRUE(port.debug);
  EXPECT_EQ(answer->sample.frame, 7);
  EXPECT_EQ(answer->sample.t_ns, 7000);
  EXPECT_THAT(answer->counters, ElementsAre(Pair("features", 120.0)));
  EXPECT_THAT(answer->timing_ms, IsEmpty());
  EXPECT_EQ(record_of(*answer).counters, answer->counters);
}

TEST(EstimatorDriver, EndsAnEstimatorThatReturnsNoUsablePose) {
  ScriptedPort port;
  port.when_tracked = [] {
    VoEstimate estimate;
    estimate.sample.state = TrackingState::kTracking;
    estimate.sample.T_vo_camera.translation.x() = std::nan("");
    return estimate;
  };
  EstimatorDriver driver(port);
  for (int i = 0; i + 1 < PoseIntake::kMostInARow; ++i) {
    const auto answer = driver.track(numbered_frame(i), false);
    ASSERT_TRUE(answer.ok()) << answer.error().message;
    EXPECT_EQ(answer->sample.state, TrackingState::kLost);
  }
  EXPECT_FALSE(driver.take_notes().empty());
  const auto last = driver.track(numbered_frame(PoseIntake::kMostInARow), false);
  ASSERT_FALSE(last.ok());
  EXPECT_EQ(last.error().code, ErrorCode::kInternal);
}

TEST(EstimatorDriver, CountsTheUseSinceTheEstimatorWasReadyAndKeepsTheLast) {
  ScriptedPort port;
  EstimatorDriver driver(port);
  EXPECT_FALSE(driver.use());
  port.use = ResourceUse{2.0, 100.0};
  driver.prepare(numbered_frame(0));
  port.use = ResourceUse{5.0, 150.0};
  ASSERT_TRUE(driver.use());
  EXPECT_EQ(driver.use()->cpu_s, 3.0);
  port.use.reset();
  ASSERT_TRUE(driver.use()) << "it has ended";
  EXPECT_EQ(driver.use()->cpu_s, 3.0);
  EXPECT_EQ(driver.use()->peak_memory_mb, 150.0);
}

}  // namespace
}  // namespace overfly::server
