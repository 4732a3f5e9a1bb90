// Sweeps flown by a program that a test writes: what is flown, again, and never twice.
#include "server/experiments/fly_sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "server/experiments/sweep_summary.hpp"
#include "server/record/run_lock.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A program in place of overfly: `program run SCENARIO --out FOLDER --quiet` copies a run that was
/// completed before, and writes a line to `calls`.
class FlySweep : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new TemporaryFolder;
    const auto run =
        run_scenario(server::testing::small_scenario({R"(estimators=[{"name":"p","type":"perfect"},
                                                        {"name":"q","type":"perfect"}])"}),
                     server::testing::options_for(shared_->path() / "run"));
    ASSERT_TRUE(run.ok()) << run.error().message;
  }
  static void TearDownTestSuite() {
    delete shared_;
    shared_ = nullptr;
  }

  /// @param flight  what the program does before it copies the run
  void write_program(const std::string& flight = "") {
    write_text(program(),
               "#!/bin/sh\nset -e\necho \"$2\" >> '" + calls().string() + "'\n" + flight +
                   "\ncp -r '" + (shared_->path() / "run").string() + "' \"$4\"\n");
    fs::permissions(program(), fs::perms::owner_all);
  }
  Sweep sweep(const std::string& fields) {
    const fs::path file = own_.path() / "sweep.json";
    const fs::path scenario = fs::path(OVERFLY_SOURCE_DIR) / "scenarios/course.json";
    write_text(file,
               R"({"format_version": 1, "scenario": ")" + scenario.string() +
                   R"(", "estimators": [{"name": "p", "type": "perfect"}], )" + fields + "}");
    Result<Sweep> loaded = load_sweep(file);
    EXPECT_TRUE(loaded.ok()) << (loaded.ok() ? "" : loaded.error().message);
    return std::move(*loaded);
  }
  Result<FlownSweep> fly(const Sweep& sweep, std::size_t jobs = 1) {
    SweepOptions options;
    options.folder = folder();
    options.program = program();
    options.jobs = jobs;
    options.cancel = &cancel_;
    options.warn = [this](const std::string& text) { warnings_.push_back(text); };
    options.progress = [this](const SweepProgress& progress) { progress_ = progress; };
    return fly_sweep(sweep, options);
  }
  [[nodiscard]] std::size_t flights() const {
    if (!fs::exists(calls())) return 0;
    const std::string text = read_text(calls());
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
  [[nodiscard]] fs::path folder() const { return own_.path() / "out"; }
  [[nodiscard]] fs::path program() const { return own_.path() / "program"; }
  [[nodiscard]] fs::path calls() const { return own_.path() / "calls"; }

  std::atomic<bool> cancel_{false};
  std::vector<std::string> warnings_;
  SweepProgress progress_;

 private:
  static TemporaryFolder* shared_;
  TemporaryFolder own_;
};
TemporaryFolder* FlySweep::shared_ = nullptr;

constexpr const char* kTwoSpeeds =
    R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10, 25]}])";

TEST_F(FlySweep, FliesEachCellOnceAndNeverAgain) {
  write_program();
  const Sweep two = sweep(std::string(kTwoSpeeds) + R"(, "repeats": {"most": 2})");
  const auto first = fly(two, 3);
  ASSERT_TRUE(first.ok()) << first.error().message;
  EXPECT_EQ(flights(), 4U);
  EXPECT_EQ(progress_.passed, 4U);
  EXPECT_EQ(progress_.flown, 4U);
  EXPECT_FALSE(first->cancelled);
  const auto rows = summary_of(*first, folder(), evaluation::AlignmentMode::kSim3);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].flights, 2);
  EXPECT_EQ(rows[0].successes, 2);
  EXPECT_EQ(rows[0].runs.size(), 2U);
  EXPECT_NE(rows[0].runs[0], rows[0].runs[1]);
  ASSERT_TRUE(rows[0].position_rmse_median_m.has_value());
  EXPECT_LT(*rows[0].position_rmse_median_m, 1e-6);
  // The runs that are named have this scenario.
  const Json scenario =
      Json::parse(read_text(folder() / "scenarios" / (rows[1].runs[0].substr(5) + ".json")));
  EXPECT_EQ(scenario.at("flight").at("course").at("airspeed_m_s"), 25);

  ASSERT_TRUE(fly(two).ok());
  EXPECT_EQ(flights(), 4U) << "nothing is due";
}

TEST_F(FlySweep, ALongerAxisFliesOnlyWhatIsNew) {
  write_program();
  ASSERT_TRUE(fly(sweep(kTwoSpeeds)).ok());
  const auto longer =
      fly(sweep(R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10, 15, 25]}])"));
  ASSERT_TRUE(longer.ok());
  EXPECT_EQ(flights(), 3U);
  EXPECT_EQ(longer->plan.cells().size(), 3U);
}

/// All estimators of a flight share its frames; one that is added, or changed, flies without those
/// that have results.
TEST_F(FlySweep, AChangedEstimatorFliesOnlyItsPart) {
  write_program();
  const std::string one = R"("axes": [{"name": "who", "variants": [{"value": "all", "set": {)";
  ASSERT_TRUE(fly(sweep(one + "}}]}]")).ok());
  const auto both = fly(sweep(one + R"("estimators": [{"name": "p", "type": "perfect"},
                                                      {"name": "q", "type": "perfect"}]}}]}])"));
  ASSERT_TRUE(both.ok()) << both.error().message;
  ASSERT_EQ(flights(), 2U);
  const auto rows = summary_of(*both, folder(), evaluation::AlignmentMode::kSim3);
  ASSERT_EQ(rows.size(), 2U);
  const Json scenario =
      Json::parse(read_text(folder() / "scenarios" / (rows[1].runs[0].substr(5) + ".json")));
  ASSERT_EQ(scenario.at("estimators").size(), 1U);
  EXPECT_EQ(scenario.at("estimators")[0].at("name"), "q");
}

TEST_F(FlySweep, AFlightThatFailsIsFlownAgainThenListedApart) {
  write_program("echo 'error: the disk is on fire' >&2; exit 5");
  const auto flown = fly(sweep(std::string(kTwoSpeeds) + R"(, "retries": 2)"));
  ASSERT_TRUE(flown.ok()) << flown.error().message;
  EXPECT_EQ(flights(), 6U);
  EXPECT_EQ(progress_.failed, 2U);
  const auto rows = summary_of(*flown, folder(), evaluation::AlignmentMode::kSim3);
  EXPECT_EQ(rows[0].flights, 0);
  EXPECT_EQ(rows[0].failed, 1);
  EXPECT_THAT(rows[0].problems, ElementsAre("exit code 5: error: the disk is on fire"));
  EXPECT_FALSE(rows[0].position_rmse_median_m.has_value());
  // The next call tries them again.
  write_program();
  const auto again = fly(sweep(kTwoSpeeds));
  EXPECT_EQ(flights(), 8U);
  EXPECT_EQ(summary_of(*again, folder(), evaluation::AlignmentMode::kSim3)[0].successes, 1);
}

TEST_F(FlySweep, AFlightHasALimitOfTime) {
  write_program("sleep 60");
  const auto flown = fly(sweep(R"("axes": [], "timeout_s": 1, "retries": 0)"));
  ASSERT_TRUE(flown.ok());
  ASSERT_EQ(flown->results.by_key().size(), 1U);
  EXPECT_THAT(flown->results.by_key().begin()->second.error, HasSubstr("timeout_s = 1"));
}

TEST_F(FlySweep, ACrashIsNamed) {
  write_program("kill -SEGV $$");
  const auto flown = fly(sweep(R"("axes": [], "retries": 0)"));
  ASSERT_TRUE(flown.ok());
  EXPECT_THAT(flown->results.by_key().begin()->second.error, HasSubstr("signal 11"));
}

/// A sweep that was killed between the end of a flight and its line in results.jsonl.
TEST_F(FlySweep, ACompletedRunWithoutItsLineIsTakenOver) {
  write_program();
  const auto flown = fly(sweep(kTwoSpeeds));
  ASSERT_TRUE(flown.ok());
  fs::remove(folder() / "results.jsonl");
  const auto again = fly(sweep(kTwoSpeeds));
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(flights(), 2U);
  EXPECT_EQ(again->results.by_key().size(), 2U);
  // A run that was interrupted is flown again.
  fs::remove(folder() / "results.jsonl");
  for (const auto& run : fs::directory_iterator(folder() / "runs")) {
    std::string manifest = read_text(run.path() / "manifest.json");
    const std::string done = R"("status": "completed")";
    manifest.replace(manifest.find(done), done.size(), R"("status": "running")");
    write_text(run.path() / "manifest.json", manifest);
  }
  ASSERT_TRUE(fly(sweep(kTwoSpeeds)).ok());
  EXPECT_EQ(flights(), 4U);
}

TEST_F(FlySweep, StopsWhenItIsCancelled) {
  write_program("exec sleep 60");
  cancel_ = true;
  const auto flown = fly(sweep(kTwoSpeeds));
  ASSERT_TRUE(flown.ok());
  EXPECT_TRUE(flown->cancelled);
  EXPECT_EQ(flights(), 0U);
  EXPECT_TRUE(flown->results.by_key().empty());
}

TEST_F(FlySweep, OnlyOneProcessWorksOnAFolder) {
  write_program();
  fs::create_directories(folder());
  const auto lock = RunLock::take(folder());
  const auto flown = fly(sweep(kTwoSpeeds));
  ASSERT_FALSE(flown.ok());
  EXPECT_EQ(flown.error().code, ErrorCode::kConflict);
  EXPECT_EQ(flights(), 0U);
}

TEST_F(FlySweep, EveryCellIsCheckedBeforeAnythingFlies) {
  write_program();
  const auto flown =
      fly(sweep(R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [25, -4, -5]}])"));
  ASSERT_FALSE(flown.ok());
  EXPECT_THAT(flown.error().message, HasSubstr("airspeed_m_s = -4"));
  EXPECT_THAT(flown.error().message, HasSubstr("airspeed_m_s = -5"));
  EXPECT_EQ(flights(), 0U);
}

/// With a success rate of 1 the interval's half-width is z^2 / (2 (n + z^2)): 0.162 at 8 flights,
/// 0.150 at 9.
TEST_F(FlySweep, RepeatsStopWhenTheRateIsKnown) {
  write_program();
  const auto flown = fly(sweep(R"("axes": [], "repeats": {"most": 20, "half_width": 0.15})"), 2);
  ASSERT_TRUE(flown.ok()) << flown.error().message;
  EXPECT_EQ(flights(), 9U);
  EXPECT_EQ(progress_.passed, 20U) << "the others need not be flown";
  const auto rows = summary_of(*flown, folder(), evaluation::AlignmentMode::kSim3);
  EXPECT_EQ(rows[0].flights, 9);
  EXPECT_NEAR(rows[0].success_interval.low, 9.0 / (9.0 + 3.841458820694124), 1e-12);
}

TEST_F(FlySweep, TheTableShowsAxesWithUnits) {
  write_program();
  const Sweep speeds = sweep(
      R"("axes": [{"path": "flight.course.airspeed_m_s", "label": "Air|speed", "unit": "m/s",
                   "values": [10]}])");
  const auto flown = fly(speeds);
  ASSERT_TRUE(flown.ok());
  const auto rows = summary_of(*flown, folder(), evaluation::AlignmentMode::kSim3);
  const std::string table = markdown_from(speeds, rows, evaluation::AlignmentMode::kSim3);
  EXPECT_THAT(table, HasSubstr("| Air\\|speed [m/s] | estimator |"));
  EXPECT_THAT(table, HasSubstr("| 10 | p | 1 | 100 [21, 100] | 0.000 |"));
  EXPECT_THAT(table, HasSubstr("1 COMPLETED"));
}

}  // namespace
}  // namespace overfly::server::experiments
