// One stream of images to several estimators: equal images, independent drops.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "server/timeline/run_timeline.hpp"
#include "tests/server/run/witness_run.hpp"
#include "tests/server/support/simulated_clock.hpp"

namespace overfly::server {
namespace {

using testing::kThree;
using testing::SimulatedClock;
using testing::WitnessRun;
using Json = nlohmann::json;

constexpr std::int64_t kMs = 1'000'000;

void expect_equal_images(const WitnessRun& flight, const RunRecords& records) {
  for (const EstimatorRecords& estimator : records.estimators) {
    int answers = 0;
    for (const EstimateRecord& record : estimator.records) {
      if (record.dropped) continue;
      ++answers;
      const FrameRow* frame = frame_row(records.main_camera(), record.sample.frame);
      ASSERT_NE(frame, nullptr);
      ASSERT_TRUE(frame->image_crc32 && record.image_crc32);
      EXPECT_EQ(*record.image_crc32, *frame->image_crc32);
      EXPECT_EQ(flight.seen.at(estimator.name).at(record.sample.frame), *frame->image_crc32);
    }
    EXPECT_GT(answers, 3) << estimator.name;
  }
}

TEST(EstimatorRun, LockstepGivesEveryEstimatorTheSameImages) {
  WitnessRun flight;
  flight.overrides = {kThree};
  flight.behaviours["b"].far_end = true;
  const RunResult run = flight.fly();
  const RunRecords records = flight.records();
  expect_equal_images(flight, records);
  EXPECT_EQ(flight.seen["a"], flight.seen["b"]);
  EXPECT_EQ(flight.seen["a"], flight.seen["c"]);
  EXPECT_EQ(flight.seen["a"].size(), 21U);
  for (const char* name : {"a", "b", "c"}) {
    const EstimatorMetrics& score = run.metrics.estimators.at(name);
    EXPECT_EQ(score.hashes_compared, 21) << name;
    EXPECT_EQ(score.hash_mismatches, 0) << name;
    EXPECT_EQ(score.dropped_frames, 0) << name;
  }
}

TEST(EstimatorRun, RealTimeGivesEachEstimatorItsOwnDropsAndTheSameImages) {
  SimulatedClock clock;
  WitnessRun flight;
  flight.clock = &clock;
  // 250 ms and 150 ms against 10 Hz: 0, 2, 4 (see real_time_test), and 0, 1 (done at 300), 2 or 3.
  flight.overrides = {kThree, "pacing=real_time", "duration_s=1"};
  flight.behaviours["a"] = {&clock, 250 * kMs};
  flight.behaviours["b"] = {&clock, 170 * kMs};
  const RunResult run = flight.fly();
  const RunRecords records = flight.records();
  expect_equal_images(flight, records);
  const auto& scores = run.metrics.estimators;
  const auto drops = [&](const char* name) { return scores.at(name).dropped_frame_ranges; };
  EXPECT_NE(drops("a"), drops("b"));
  EXPECT_GT(scores.at("a").dropped_frames, scores.at("b").dropped_frames);
  EXPECT_EQ(scores.at("c").dropped_frames, 0);
  for (const EstimatorRecords& estimator : records.estimators) {
    EXPECT_EQ(estimator.records.size(), records.main_camera().frames.size())
        << "each frame, answered or dropped";
  }
}

/// The paper's ORB-SLAM2 processed 20 of 31 frames per second.
TEST(EstimatorRun, ThrottledToTwentyOfThirtyOneHertzDropsTheRest) {
  SimulatedClock clock;
  WitnessRun flight;
  flight.clock = &clock;
  flight.overrides = {
      R"(estimators=[{"name":"t","type":"feature","throttle_hz":20},{"name":"u","type":"feature"}])",
      R"(camera={"width_px":32,"height_px":24,"rate_hz":31})",
      "pacing=real_time",
      "duration_s=20"};
  const RunResult run = flight.fly();
  const EstimatorMetrics& score = run.metrics.estimators.at("t");
  const double frames = static_cast<double>(run.info.frames);
  const auto dropped = static_cast<double>(score.dropped_frames);
  EXPECT_EQ(run.info.frames, 621);
  EXPECT_NEAR(100.0 * dropped / frames, 35.5, 1.0);
  EXPECT_EQ(run.metrics.estimators.at("u").dropped_frames, 0);
  // Its latency is at least that of one that needs 1 / 20 s.
  const Json latency = flight.timings().at("estimators").at("t").at("latency");
  EXPECT_GE(latency.at("median_ms").get<double>(), 50.0);
  EXPECT_LE(latency.at("max_ms").get<double>(), 50.0 + 1000.0 / 31.0 + 50.0);
}

TEST(EstimatorRun, DamagedImagesAndMissingAnswersAreCounted) {
  WitnessRun flight;
  flight.overrides = {kThree};
  flight.behaviours["a"].far_end = true;
  flight.behaviours["a"].garbled = 4;
  flight.behaviours["b"].silent = 5;
  const RunResult run = flight.fly();
  const auto& scores = run.metrics.estimators;
  EXPECT_EQ(scores.at("a").hash_mismatches, 1);
  EXPECT_EQ(scores.at("b").hash_mismatches, 0);
  EXPECT_EQ(scores.at("b").unanswered, 1);
  EXPECT_EQ(scores.at("a").unanswered, 0);
  const auto timeline = RunTimeline::open(flight.folder.path() / "r");
  ASSERT_TRUE(timeline.ok()) << timeline.error().message;
  EXPECT_EQ((*timeline)->estimates(1, 4, 1).at(0).unanswered_frames, 0);
  EXPECT_EQ((*timeline)->estimates(1, 5, 1).at(0).unanswered_frames, 1);
  EXPECT_EQ((*timeline)->estimates(1, 20, 1).at(0).unanswered_frames, 1);
}

}  // namespace
}  // namespace overfly::server
