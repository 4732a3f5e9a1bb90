// One stream of images to several estimators: equal images, own drops, own ends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include "server/estimators/estimator_worker.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/estimator_tally.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_info.hpp"
#include "server/record/run_records.hpp"
#include "server/record/run_timeline.hpp"
#include "server/run/run_options.hpp"
#include "tests/server/support/engine_fixture.hpp"
#include "tests/server/support/simulated_clock.hpp"

namespace overfly::engine {
namespace {

using overfly::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::SimulatedClock;
using Json = nlohmann::json;

constexpr std::int64_t kMs = 1'000'000;

/// CRC-32 bit by bit, from its definition (ISO 3309): independent of the program's tables.
std::uint32_t plain_crc32(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t rest = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    rest ^= byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1U) ^ ((rest & 1U) * 0xEDB88320U);
  }
  return ~rest;
}

/// Behaves as its name says, and notes the CRC of each image that it gets.
class Witness final : public VoPort {
 public:
  struct Habits {
    RunClock* clock = nullptr;
    std::int64_t work_ns = 0;
    bool far_end = false;               ///< tells the CRC itself, as one behind a door
    std::int64_t garbled = -1;          ///< frame that reaches it damaged
    std::int64_t silent = -1;           ///< frame that it does not answer
    std::int64_t absurd = -1;           ///< frame that it answers with what is no number
    bool absurd_from_there = false;     ///< and all after it
    std::vector<std::string> log = {};  ///< said at its first frame
    std::string unready = {};           ///< why it does not get ready
    std::int64_t cancelled = -1;        ///< frame in which the run's end reaches it
  };
  using Seen = std::map<std::int64_t, std::uint32_t>;
  Witness(Habits habits, Seen& seen) : habits_(std::move(habits)), seen_(seen) {}

  std::string type() const override { return "witness"; }
  std::map<std::string, std::string> effective_parameters() const override {
    // Changes its mind after the first frame, as systems whose modes override their settings do.
    return {{"threshold", seen_.empty() ? "7" : "3"}, {"levels", "8"}};
  }
  Status prepare(const VoFrame& /*first*/) override {
    if (habits_.unready.empty()) return {};
    return Error{ErrorCode::kInternal, habits_.unready};
  }
  Result<VoEstimate> track(const VoFrame& frame) override {
    if (seen_.empty()) {
      const std::lock_guard lock(mutex_);
      said_ = habits_.log;
    }
    if (frame.index == habits_.cancelled) return Error{ErrorCode::kCancelled, "stopped"};
    seen_[frame.index] = plain_crc32(frame.image->data);
    if (habits_.work_ns > 0) {
      habits_.clock->sleep_until_ns(habits_.clock->now_ns() + habits_.work_ns);
    }
    VoEstimate estimate;
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    estimate.sample.state = TrackingState::kTracking;
    estimate.sample.T_vo_camera.translation.x() = static_cast<double>(frame.index);
    if (habits_.far_end) {
      estimate.image_crc32 = seen_[frame.index] + (frame.index == habits_.garbled ? 1U : 0U);
    }
    const bool later = habits_.absurd_from_there && frame.index > habits_.absurd;
    if (frame.index == habits_.absurd || later) {
      estimate.sample.frame = 77;
      estimate.sample.T_vo_camera.translation.x() = std::nan("");
      estimate.sample.scene_depth = std::numeric_limits<double>::infinity();
      estimate.counters = {{"features", std::nan("")}, {"inliers", 3.0}};
    }
    if (frame.index == habits_.silent) {
      estimate.sample.state = TrackingState::kLost;
      estimate.counters["unanswered"] = 1.0;
    }
    return estimate;
  }
  void reset() override {}
  void set_debug(bool /*wanted*/) override {}
  std::vector<std::string> take_log() override {
    const std::lock_guard lock(mutex_);
    return std::exchange(said_, {});
  }
  std::optional<ResourceUse> resource_use() const override {
    if (!habits_.far_end) return std::nullopt;
    // It has used much before its first frame.
    return ResourceUse{30.0 + 0.5 * static_cast<double>(seen_.size()), 42.0};
  }

 private:
  Habits habits_;
  Seen& seen_;
  std::mutex mutex_;
  std::vector<std::string> said_;
};

struct Flight {
  TemporaryFolder folder;
  std::map<std::string, Witness::Habits> habits;
  std::map<std::string, Witness::Seen> seen;
  std::vector<std::string> overrides;
  RunClock* clock = nullptr;

  RunOptions options() {
    RunOptions options;
    options.folder = folder.path() / "r";
    options.renderer_factory = testing::noop_factory();
    options.clock = clock;
    options.estimator_factory = [this](const EstimatorSpec& spec) {
      return Result<std::unique_ptr<VoPort>>(
          std::make_unique<Witness>(habits[spec.name], seen[spec.name]));
    };
    return options;
  }
  RunResult fly() {
    const auto run = run_scenario(testing::small_scenario(overrides), options());
    if (!run) throw std::runtime_error(run.error().message);
    return *run;
  }
  RunRecords records() const { return read_run_records(folder.path() / "r").value(); }
  Json manifest() const { return read_json(manifest_file(folder.path() / "r")).value(); }
  Json timings() const { return read_json(timings_file(folder.path() / "r")).value(); }
};

void expect_equal_images(const Flight& flight, const RunRecords& records) {
  for (const EstimatorRecords& estimator : records.estimators) {
    int answers = 0;
    for (const EstimateRecord& record : estimator.records) {
      if (record.dropped) continue;
      ++answers;
      const FrameRecord* frame = frame_record(records, 0, record.sample.frame);
      ASSERT_NE(frame, nullptr);
      ASSERT_TRUE(frame->row.image_crc32 && record.image_crc32);
      EXPECT_EQ(*record.image_crc32, *frame->row.image_crc32);
      EXPECT_EQ(flight.seen.at(estimator.name).at(record.sample.frame), *frame->row.image_crc32);
    }
    EXPECT_GT(answers, 3) << estimator.name;
  }
}

constexpr const char* kThree =
    R"(estimators=[{"name":"a","type":"feature"},{"name":"b","type":"feature"},)"
    R"({"name":"c","type":"feature"}])";

TEST(EstimatorRun, LockstepGivesEveryEstimatorEveryImageTheSame) {
  Flight flight;
  flight.overrides = {kThree};
  flight.habits["b"].far_end = true;
  const RunResult run = flight.fly();
  const RunRecords records = flight.records();
  expect_equal_images(flight, records);
  EXPECT_EQ(flight.seen["a"], flight.seen["b"]);
  EXPECT_EQ(flight.seen["a"], flight.seen["c"]);
  EXPECT_EQ(flight.seen["a"].size(), 21U);
  for (const char* name : {"a", "b", "c"}) {
    const Json& score = run.metrics.at("estimators").at(name);
    EXPECT_EQ(score.at("hashes_compared"), 21) << name;
    EXPECT_EQ(score.at("hash_mismatches"), 0) << name;
    EXPECT_EQ(score.at("dropped_frames"), 0) << name;
  }
}

TEST(EstimatorRun, RealTimeGivesEachEstimatorItsOwnDropsAndTheSameImages) {
  SimulatedClock clock;
  Flight flight;
  flight.clock = &clock;
  // 250 ms and 150 ms against 10 Hz: 0, 2, 4 (see real_time_test), and 0, 1 (done at 300), 2 or 3.
  flight.overrides = {kThree, "pacing=real_time", "duration_s=1"};
  flight.habits["a"] = {&clock, 250 * kMs};
  flight.habits["b"] = {&clock, 170 * kMs};
  const RunResult run = flight.fly();
  const RunRecords records = flight.records();
  expect_equal_images(flight, records);
  const Json& scores = run.metrics.at("estimators");
  const auto drops = [&](const char* name) { return scores.at(name).at("dropped_frame_ranges"); };
  EXPECT_NE(drops("a"), drops("b"));
  EXPECT_GT(scores.at("a").at("dropped_frames"), scores.at("b").at("dropped_frames"));
  EXPECT_EQ(scores.at("c").at("dropped_frames"), 0);
  for (const EstimatorRecords& estimator : records.estimators) {
    EXPECT_EQ(estimator.records.size(), records.frames.size()) << "each frame, got or dropped";
  }
}

/// The paper's ORB-SLAM2 took 20 frames a second of 31.
TEST(EstimatorRun, ThrottledToTwentyOfThirtyOneHertzDropsTheRest) {
  SimulatedClock clock;
  Flight flight;
  flight.clock = &clock;
  flight.overrides = {
      R"(estimators=[{"name":"t","type":"feature","throttle_hz":20},{"name":"u","type":"feature"}])",
      R"(camera={"width_px":32,"height_px":24,"rate_hz":31})",
      "pacing=real_time",
      "duration_s=20"};
  const RunResult run = flight.fly();
  const Json& score = run.metrics.at("estimators").at("t");
  const double frames = static_cast<double>(run.info.frames);
  const double dropped = score.at("dropped_frames").get<double>();
  EXPECT_EQ(run.info.frames, 621);
  EXPECT_NEAR(100.0 * dropped / frames, 35.5, 1.0);
  EXPECT_EQ(run.metrics.at("estimators").at("u").at("dropped_frames"), 0);
  // It answers no sooner than one that needs 1 / 20 s.
  const Json latency = flight.timings().at("estimators").at("t").at("latency");
  EXPECT_GE(latency.at("median_ms").get<double>(), 50.0);
  EXPECT_LE(latency.at("max_ms").get<double>(), 50.0 + 1000.0 / 31.0 + 50.0);
}

TEST(EstimatorRun, DamagedImagesAndMissingAnswersAreCounted) {
  Flight flight;
  flight.overrides = {kThree};
  flight.habits["a"].far_end = true;
  flight.habits["a"].garbled = 4;
  flight.habits["b"].silent = 5;
  const RunResult run = flight.fly();
  const Json& scores = run.metrics.at("estimators");
  EXPECT_EQ(scores.at("a").at("hash_mismatches"), 1);
  EXPECT_EQ(scores.at("b").at("hash_mismatches"), 0);
  EXPECT_EQ(scores.at("b").at("unanswered"), 1);
  EXPECT_EQ(scores.at("a").at("unanswered"), 0);
}

/// A run folder with a number that is none could not be read back.
TEST(EstimatorRun, AnswersThatAreNoNumbersLeaveTheFolderReadable) {
  Flight flight;
  flight.overrides = {R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.habits["a"].absurd = 6;
  flight.fly();
  const RunRecords records = flight.records();
  const EstimateRecord& record = records.estimators[0].records.at(6);
  EXPECT_EQ(record.sample.frame, 6);
  EXPECT_EQ(record.sample.state, TrackingState::kLost);
  EXPECT_FALSE(record.sample.scene_depth.has_value());
  EXPECT_EQ(record.counters, (std::map<std::string, double>{{"inliers", 3.0}}));
  EXPECT_EQ(records.estimators[0].records.at(7).sample.state, TrackingState::kTracking);
  EXPECT_THAT(overfly::testing::read_text(log_file(flight.folder.path() / "r")),
              HasSubstr("warning: frame 6: the position is not finite"));
}

TEST(EstimatorRun, OneWithoutAUsablePoseForLongIsGivenUp) {
  Flight flight;
  flight.overrides = {"duration_s=5", R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.habits["a"].absurd = 6;
  flight.habits["a"].absurd_from_there = true;
  const RunResult run = flight.fly();
  const Json& score = run.metrics.at("estimators").at("a");
  EXPECT_EQ(score.at("outcome"), "CRASHED");
  EXPECT_EQ(score.at("outcome_time_s"), 0.1 * (6 + PoseIntake::kMostInARow - 1));
  EXPECT_THAT(score.at("crash").get<std::string>(),
              HasSubstr("30 answers in a row had no usable pose"));
}

TEST(EstimatorRun, UseStandsInTheTimingsAndReadsBack) {
  Flight flight;
  flight.overrides = {kThree};
  flight.habits["a"].far_end = true;
  flight.fly();
  const Json timings = flight.timings();
  const Json& outside = timings.at("estimators").at("a").at("resources");
  EXPECT_EQ(outside.at("measured"), "process");
  EXPECT_EQ(outside.at("cpu_s"), 10.5);
  EXPECT_EQ(outside.at("peak_memory_mb"), 42.0);
  const Json& native = timings.at("estimators").at("b").at("resources");
  EXPECT_EQ(native.at("measured"), "calling_thread");
  EXPECT_TRUE(native.at("peak_memory_mb").is_null());
  EXPECT_GT(native.at("cpu_s").get<double>(), 0.0);
  EXPECT_GT(timings.at("peak_memory_mb").get<double>(), 1.0);
  const auto timeline = RunTimeline::open(flight.folder.path() / "r");
  ASSERT_TRUE(timeline.ok()) << timeline.error().message;
  const std::vector<EstimatorStatus> statuses = (*timeline)->statuses();
  ASSERT_EQ(statuses.size(), 3U);
  EXPECT_EQ(statuses[0].answered, 21);
  EXPECT_EQ(statuses[0].hashes_compared, 21);
  EXPECT_EQ(state_text(statuses[0]), "TRACKING");
  ASSERT_TRUE(statuses[0].use && statuses[0].latency);
  EXPECT_EQ(*statuses[0].use->peak_memory_mb, 42.0);
  EXPECT_LE(statuses[0].latency->median_ms, statuses[0].latency->p99_ms);
}

TEST(EstimatorRun, ParametersAreReadBackAtTheEndAndAChangeIsTold) {
  Flight flight;
  flight.overrides = {R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.fly();
  const Json entry = flight.manifest().at("estimators").at(0);
  EXPECT_EQ(entry.at("parameters").at("threshold"), "7");
  EXPECT_EQ(entry.at("parameters_at_end").at("threshold"), "3");
  EXPECT_EQ(entry.at("parameters_at_end").at("levels"), "8");
  const std::string log = overfly::testing::read_text(log_file(flight.folder.path() / "r"));
  EXPECT_THAT(log, HasSubstr("parameter threshold is 3 at the end, but at the start it was 7"));
  EXPECT_THAT(log, ::testing::Not(HasSubstr("levels")));
}

TEST(EstimatorRun, WhatAnEstimatorSaysIsInTheLogUnderItsName) {
  Flight flight;
  flight.overrides = {R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.habits["a"].log = {"loaded the vocabulary", "error: no loop closing", "warning: slow"};
  flight.fly();
  const auto rows = read_lines(log_file(flight.folder.path() / "r"));
  ASSERT_TRUE(rows.ok());
  std::map<std::string, std::string> said;
  for (const Json& row : *rows) {
    if (row.value("source", "") == "a") said[row.at("text")] = row.at("level");
  }
  EXPECT_EQ(said.at("loaded the vocabulary"), "info");
  EXPECT_EQ(said.at("error: no loop closing"), "error");
  EXPECT_EQ(said.at("warning: slow"), "warning");
}

TEST(EstimatorRun, AFloodOfLinesIsCutShort) {
  Flight flight;
  flight.overrides = {R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.habits["a"].log.assign(5000, std::string(5000, 'x'));
  flight.fly();
  const auto rows = read_lines(log_file(flight.folder.path() / "r"));
  ASSERT_TRUE(rows.ok());
  std::vector<std::string> said;
  for (const Json& row : *rows) {
    if (row.value("source", "") == "a") said.push_back(row.at("text"));
  }
  ASSERT_EQ(said.size(), 1001U);
  EXPECT_EQ(said.front().size(), 1000U);
  EXPECT_THAT(said.back(), HasSubstr("too many lines"));
}

TEST(EstimatorRun, OneThatDoesNotStartIsCrashedAndTheOthersFly) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path() / "r";
  options.renderer_factory = testing::noop_factory();
  const auto run = run_scenario(
      testing::small_scenario(
          {R"(estimators=[{"name":"gone","type":"process","command":["/nowhere/at-all"]},)"
           R"({"name":"p","type":"perfect"}])"}),
      options);
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_EQ(run->info.status, RunStatus::kCompleted);
  const Json& scores = run->metrics.at("estimators");
  EXPECT_EQ(scores.at("gone").at("outcome"), "CRASHED");
  EXPECT_EQ(scores.at("p").at("outcome"), "COMPLETED");
  const Json manifest = read_json(manifest_file(options.folder)).value();
  EXPECT_THAT(manifest.at("estimators").at(0).at("start_error").get<std::string>(),
              HasSubstr("/nowhere/at-all"));
  EXPECT_FALSE(manifest.at("estimators").at(1).contains("start_error"));
  const auto timeline = RunTimeline::open(options.folder);
  ASSERT_TRUE(timeline.ok());
  const EstimatorStatus status = (*timeline)->statuses().at(0);
  EXPECT_EQ(state_text(status), "CRASHED");
  EXPECT_THAT(status.crash, AllOf(HasSubstr("did not start"), HasSubstr("/nowhere/at-all")));
  EXPECT_EQ(status.answered, 0);
  EXPECT_FALSE(status.latency.has_value());
  EXPECT_THAT(overfly::testing::read_text(log_file(options.folder)),
              ::testing::Not(HasSubstr("gone lost track")));
}

TEST(EstimatorRun, OneThatDoesNotGetReadyIsCrashedAndTheOthersFly) {
  Flight flight;
  flight.overrides = {kThree};
  flight.habits["b"].unready = "no vocabulary";
  const RunResult run = flight.fly();
  EXPECT_EQ(run.metrics.at("estimators").at("b").at("outcome"), "CRASHED");
  EXPECT_EQ(run.metrics.at("estimators").at("a").at("outcome"), "COMPLETED");
  EXPECT_TRUE(flight.seen["b"].empty());
  EXPECT_EQ(flight.records().estimators[1].records[0].crash, "no vocabulary");
}

TEST(EstimatorRun, OneThatIsStoppedInAFrameHasNotCrashed) {
  Flight flight;
  flight.overrides = {R"(estimators=[{"name":"a","type":"feature"}])"};
  flight.habits["a"].cancelled = 20;  // the last
  const RunResult run = flight.fly();
  EXPECT_EQ(run.metrics.at("estimators").at("a").at("outcome"), "COMPLETED");
  EXPECT_EQ(run.metrics.at("estimators").at("a").at("dropped_frames"), 1);
}

TEST(EstimatorRun, ProcessorThatIsNotThereIsTold) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path() / "r";
  options.renderer_factory = testing::noop_factory();
  const auto run = run_scenario(
      testing::small_scenario({R"(estimators=[{"name":"p","type":"perfect","cpus":[1023]}])"}),
      options);
  ASSERT_FALSE(run.ok());
  EXPECT_THAT(run.error().message, AllOf(HasSubstr("\"p\""), HasSubstr("cpus = [1023]")));
}

}  // namespace
}  // namespace overfly::engine
