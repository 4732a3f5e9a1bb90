// Sweeps flown by a program that a test writes: what is flown, again, and never twice.
#include "server/experiments/fly_sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "server/experiments/envelope/envelope.hpp"
#include "server/experiments/sweep_folders.hpp"
#include "server/experiments/sweep_summary.hpp"
#include "server/record/run_lock.hpp"
#include "tests/server/experiments/fly_sweep_fixture.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

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

  const Json entry = sweep_entry(own_folder(), "out").value();
  EXPECT_EQ(entry.at("progress").at("passed"), 4);
  EXPECT_EQ(entry.at("progress").at("most"), 4);
  EXPECT_EQ(entry.at("axes").at(0).at("values"), Json::array({10, 25}));

  ASSERT_TRUE(fly(two).ok());
  EXPECT_EQ(flights(), 4U) << "nothing is due";
}

TEST_F(FlySweep, ALongerAxisFliesOnlyWhatIsNew) {
  write_program();
  ASSERT_TRUE(fly(sweep(kTwoSpeeds)).ok());
  const double two_s = progress_.spent_s;
  EXPECT_GT(two_s, 0.0);
  const auto longer =
      fly(sweep(R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10, 15, 25]}])"));
  ASSERT_TRUE(longer.ok());
  EXPECT_EQ(flights(), 3U);
  EXPECT_EQ(longer->plan.cells().size(), 3U);
  const double three_s = progress_.spent_s;
  EXPECT_GT(three_s, two_s) << "earlier calls count";
  ASSERT_TRUE(fly(sweep(kTwoSpeeds)).ok());
  EXPECT_DOUBLE_EQ(progress_.spent_s, three_s) << "nothing was flown";
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

/// After a change, tables have no results of before: a sweep that is cancelled then would mix them.
TEST_F(FlySweep, ResultsOfBeforeAChangeAreWithdrawnBeforeItFlies) {
  write_program();
  ASSERT_TRUE(fly(sweep(kTwoSpeeds)).ok());
  EXPECT_THAT(SweepResults::read(folder())->newest(), SizeIs(2));
  const Sweep changed = sweep(std::string(kTwoSpeeds) + R"(, "set": {"camera": {"rate_hz": 11}})");
  SweepOptions until_first = options(1);
  until_first.progress = [this](const SweepProgress& progress) { cancel_ = progress.flown == 1; };
  const auto stopped = fly_sweep(changed, until_first);
  ASSERT_TRUE(stopped.ok()) << stopped.error().message;
  EXPECT_TRUE(stopped->cancelled);
  EXPECT_EQ(flights(), 3U);
  const auto after = SweepResults::read(folder());
  ASSERT_THAT(after->newest(), SizeIs(1));
  EXPECT_EQ(after->newest().front()->key, stopped->plan.results_of(0, "p", *after).front()->key);
  // The results are still known: without the change nothing is flown.
  cancel_ = false;
  ASSERT_TRUE(fly(sweep(kTwoSpeeds)).ok());
  EXPECT_EQ(flights(), 3U);
  EXPECT_THAT(SweepResults::read(folder())->newest(), SizeIs(2));
}

TEST_F(FlySweep, IsCancelledBeforeItsFirstFlightToo) {
  write_program();
  const Sweep two = sweep(kTwoSpeeds);
  cancel_ = true;
  const auto stopped = fly(two);
  ASSERT_FALSE(stopped.ok());
  EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
  EXPECT_EQ(flights(), 0U);
  const auto read = read_sweep(two, folder(), &cancel_);
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().code, ErrorCode::kCancelled);
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

/// Its program is missing, say: the run is complete, but says nothing about the estimator.
TEST_F(FlySweep, AnEstimatorThatNeverRanHasNoResult) {
  const fs::path without = own_folder() / "without";
  copy_run_without({"p", "q"}, without);
  write_program("cp -r '" + without.string() + "' \"$4\"; exit");
  const Sweep one = sweep(R"("axes": [], "retries": 3)");
  const auto flown = fly(one);
  ASSERT_TRUE(flown.ok()) << flown.error().message;
  EXPECT_EQ(flights(), 1U) << "it would not start now either";
  EXPECT_EQ(progress_.failed, 1U);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("estimator p never ran: there is no such file")));
  const auto rows = summary_of(*flown, folder(), evaluation::AlignmentMode::kSim3);
  EXPECT_EQ(rows[0].flights, 0);
  EXPECT_EQ(rows[0].failed, 1);
  EXPECT_TRUE(rows[0].outcomes.empty());
  // The run that is there is not taken for a result by the next call.
  write_program();
  const auto again = fly(one);
  EXPECT_EQ(flights(), 2U);
  EXPECT_EQ(summary_of(*again, folder(), evaluation::AlignmentMode::kSim3)[0].successes, 1);
}

TEST_F(FlySweep, OnlyTheEstimatorThatNeverRanIsFlownAgain) {
  const fs::path without = own_folder() / "without";
  copy_run_without({"q"}, without);
  write_program("cp -r '" + without.string() + "' \"$4\"; exit");
  Sweep two = sweep(R"("axes": [], "retries": 0)");
  two.changes.back().value =
      Json::parse(R"([{"name": "p", "type": "perfect"}, {"name": "q", "type": "perfect"}])");
  const auto flown = fly(two);
  ASSERT_TRUE(flown.ok()) << flown.error().message;
  EXPECT_EQ(progress_.failed, 1U);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("estimator q never ran: ")));
  auto rows = summary_of(*flown, folder(), evaluation::AlignmentMode::kSim3);
  EXPECT_EQ(rows[0].successes, 1) << "of p";
  EXPECT_EQ(rows[1].failed, 1);
  write_program();
  const auto again = fly(two);
  EXPECT_EQ(flights(), 2U);
  rows = summary_of(*again, folder(), evaluation::AlignmentMode::kSim3);
  EXPECT_EQ(rows[1].successes, 1);
  const Json scenario =
      Json::parse(read_text(folder() / "scenarios" / (rows[1].runs[0].substr(5) + ".json")));
  ASSERT_EQ(scenario.at("estimators").size(), 1U) << "p has its result";
}

TEST_F(FlySweep, ThePlanNamesProgramsThatAreMissing) {
  Sweep one = sweep(R"("axes": [])");
  one.changes.back().value =
      Json::parse(R"([{"name": "mine", "type": "process", "command": ["/no/such/program"]}])");
  const auto planned = read_sweep(one, folder());
  ASSERT_TRUE(planned.ok()) << planned.error().message;
  EXPECT_THAT(planned->plan.absent_programs(),
              ElementsAre(HasSubstr("estimator mine: command[0] = '/no/such/program'")));
}

TEST_F(FlySweep, AFlightHasALimitOfTime) {
  write_program("exec sleep 60");
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

TEST_F(FlySweep, AnErrorOfAllCellsIsNamedOnce) {
  write_program();
  const auto flown = fly(sweep(
      R"("set": {"camera.rate_hz": -1},
         "axes": [{"path": "flight.course.airspeed_m_s", "values": [10, 15, 20]}])"));
  ASSERT_FALSE(flown.ok());
  const std::string& message = flown.error().message;
  EXPECT_THAT(message, HasSubstr("camera.rate_hz = -1"));
  EXPECT_THAT(message, HasSubstr("(in 3 cells; the first is flight.course.airspeed_m_s = 10)"));
  EXPECT_EQ(message.find("camera.rate_hz"), message.rfind("camera.rate_hz"));
}

TEST_F(FlySweep, TheTimeLeftIsUnknownBeforeTheFirstFlightIsOver) {
  write_program();
  SweepOptions one_at_once = options(1);
  std::vector<std::optional<double>> left_s;
  one_at_once.progress = [&](const SweepProgress& progress) { left_s.push_back(progress.left_s); };
  ASSERT_TRUE(fly_sweep(sweep(kTwoSpeeds), one_at_once).ok());
  EXPECT_FALSE(left_s.front().has_value());
  EXPECT_EQ(left_s.back(), 0.0);
}

TEST_F(FlySweep, ProgressIsShownWhenItChanges) {
  write_program("sleep 0.5");
  SweepOptions two_at_once = options(2);
  std::size_t shown = 0;
  two_at_once.progress = [&](const SweepProgress&) { ++shown; };
  ASSERT_TRUE(fly_sweep(sweep(R"("axes": [])"), two_at_once).ok());
  EXPECT_LE(shown, 4U) << "at the start, before and after the flight, and at the end";
}

TEST_F(FlySweep, TheTimeLeftCountsFlightsAtTheSameTime) {
  write_program("sleep 0.2");
  SweepOptions two_at_once = options(2);
  std::optional<SweepProgress> first;
  two_at_once.progress = [&](const SweepProgress& progress) {
    if (!first && progress.flown == 1) first = progress;
  };
  ASSERT_TRUE(
      fly_sweep(sweep(R"("axes": [{"path": "seed", "values": [1, 2, 3]}])"), two_at_once).ok());
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->passed, 1U);
  EXPECT_DOUBLE_EQ(first->left_s.value(), 2.0 * first->spent_s / 2.0);
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

/// The program of the test copies a run that was lost for every speed above 20 m/s.
TEST_F(FlySweep, TheEnvelopeFliesOnlyTheCellsAtTheBorder) {
  const fs::path lost = own_folder() / "lost";
  write_program("if grep -q '\"airspeed_m_s\": *\\(2[1-9]\\|3\\)' \"$2\"; then cp -r '" +
                lost.string() + "' \"$4\"; exit; fi");
  copy_run(lost);
  const std::string metrics = read_text(lost / "metrics.json");
  Json changed = Json::parse(metrics);
  changed["estimators"]["p"]["outcome"] = "LOST";
  write_text(lost / "metrics.json", changed.dump());
  const Sweep grid = sweep(
      R"("axes": [{"path": "flight.course.airspeed_m_s", "label": "Airspeed", "unit": "m/s",
                   "from": 15, "to": 30, "step": 1},
                  {"path": "seed", "values": [1, 2, 3]}])");
  EnvelopeOptions options;
  options.flights.folder = folder();
  options.flights.program = program();
  options.border.axis = "flight.course.airspeed_m_s";
  options.progress = [&](std::size_t) {
    EXPECT_TRUE(RunLock::held(folder())) << "also between rounds of flights";
  };
  const auto found = find_envelope(grid, options);
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_EQ(found->cells, 48U);
  EXPECT_EQ(found->cells_needed, 6U + 2U + 2U);
  EXPECT_EQ(flights(), found->cells_needed);
  ASSERT_EQ(found->lines.size(), 3U);
  for (const EnvelopeLine& line : found->lines) {
    EXPECT_EQ(line.survives.value(), 20) << line.at;
    EXPECT_EQ(line.fails.value(), 21) << line.at;
  }
  EXPECT_THAT(markdown_from(grid, *found), HasSubstr("| 2 | 20.0 m/s | 21.0 m/s | |"));
  EXPECT_EQ(json_from(*found).at("lines").at(2).at("at"), Json({{"seed", 3}}));
  ASSERT_TRUE(find_envelope(grid, options).ok());
  EXPECT_EQ(flights(), found->cells_needed) << "nothing is flown again";

  options.border.axis = "seed.x";
  EXPECT_THAT(find_envelope(grid, options).error().message,
              HasSubstr("axis = seed.x: must be an axis of the sweep with at least two values "
                        "(flight.course.airspeed_m_s, seed)"));
  options.border.axis = "flight.course.airspeed_m_s";
  options.border.estimator = "none";
  EXPECT_THAT(find_envelope(grid, options).error().message, HasSubstr("estimator = none"));
  const Sweep skipping = sweep(
      R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [15, 25]}, {"path": "seed", "values": [1, 2]}],
         "skip": [{"flight.course.airspeed_m_s": 25, "seed": 2}])");
  options.border.estimator.clear();
  EXPECT_THAT(find_envelope(skipping, options).error().message,
              HasSubstr("skip: must leave out no cell"));
}

}  // namespace
}  // namespace overfly::server::experiments
