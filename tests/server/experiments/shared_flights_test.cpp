// Sweeps in which cells and repeats have the same flight: it is flown once, and each has its
// result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "server/experiments/sweep_summary.hpp"
#include "tests/server/experiments/fly_sweep_fixture.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;
using overfly::testing::read_text;
using overfly::testing::write_text;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Repeat 1 of seed 1 is repeat 0 of seed 2, and so on: five flights for nine.
constexpr const char* kSeeds =
    R"("axes": [{"path": "seed", "values": [1, 2, 3]}], "repeats": {"most": 3})";
constexpr const char* kTwins =
    R"("axes": [{"name": "air", "variants": [{"value": "a", "set": {}}, {"value": "b", "set": {}}]}])";

class SharedFlights : public FlySweep {
 protected:
  [[nodiscard]] std::vector<CellSummary> rows_of(const FlownSweep& flown) const {
    return summary_of(flown, folder(), evaluation::AlignmentMode::kSim3);
  }
  [[nodiscard]] std::filesystem::path results() const { return folder() / "results.jsonl"; }
};

TEST_F(SharedFlights, AreFlownOnceAlsoAtTheSameTime) {
  for (const std::size_t jobs : {1U, 2U, 5U}) {
    std::filesystem::remove_all(folder());
    std::filesystem::remove(calls());
    write_program("sleep 0.1");
    const Sweep seeds = sweep(kSeeds);
    const auto flown = fly(seeds, jobs);
    ASSERT_TRUE(flown.ok()) << flown.error().message;
    EXPECT_EQ(flights(), 5U) << jobs;
    EXPECT_THAT(warnings_, IsEmpty());
    EXPECT_EQ(progress_.passed, 9U);
    EXPECT_EQ(progress_.flown, 5U);
    for (const CellSummary& row : rows_of(*flown)) EXPECT_EQ(row.successes, 3) << row.cell;
    std::set<std::string> lines;
    for (const SweepResult* result : flown->results.newest()) {
      const int seed = result->cell.at("seed").get<int>() + result->repeat;
      EXPECT_EQ(result->seed, static_cast<std::uint64_t>(seed));
      lines.insert(result->cell.dump() + std::to_string(result->repeat));
    }
    EXPECT_THAT(lines, SizeIs(9)) << "each cell and repeat has a result";
    const std::string written = read_text(results());
    ASSERT_TRUE(fly(seeds, jobs).ok());
    EXPECT_EQ(flights(), 5U) << "nothing is due";
    EXPECT_EQ(read_text(results()), written);
  }
}

/// As an earlier version left it, or a kill between a flight's lines.
TEST_F(SharedFlights, LinesThatLackAreAddedWithoutAFlight) {
  write_program();
  const Sweep seeds = sweep(kSeeds);
  EXPECT_EQ(read_sweep(seeds, folder())->progress.passed, 4U) << "five are to be flown";
  ASSERT_TRUE(fly(seeds).ok());
  std::istringstream text(read_text(results()));
  std::set<std::string> keys;
  std::string kept;
  for (std::string line; std::getline(text, line);) {
    if (keys.insert(Json::parse(line).at("key")).second) kept += line + "\n";
  }
  ASSERT_THAT(keys, SizeIs(5));
  write_text(results(), kept);
  EXPECT_THAT(read_sweep(seeds, folder())->results.newest(), SizeIs(5));
  const auto again = fly(seeds);
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(flights(), 5U);
  EXPECT_THAT(again->results.newest(), SizeIs(9));
  EXPECT_THAT(read_sweep(seeds, folder())->results.newest(), SizeIs(9));
}

/// A cell whose flights are another one's waits for them, and flies none beyond its rule.
TEST_F(SharedFlights, StopWhenTheRateIsKnown) {
  write_program("sleep 0.05");
  const auto flown =
      fly(sweep(std::string(kTwins) + R"(, "repeats": {"most": 20, "half_width": 0.15})"), 2);
  ASSERT_TRUE(flown.ok()) << flown.error().message;
  EXPECT_EQ(flights(), 9U);
  EXPECT_EQ(progress_.passed, 40U);
  for (const CellSummary& row : rows_of(*flown)) EXPECT_EQ(row.flights, 9) << row.cell;
  EXPECT_THAT(flown->results.newest(), SizeIs(18));
}

TEST_F(SharedFlights, ThatFailAreTriedOnceInEachCall) {
  for (const std::size_t jobs : {1U, 2U}) {
    std::filesystem::remove_all(folder());
    std::filesystem::remove(calls());
    const Sweep twins = sweep(std::string(kTwins) + R"(, "retries": 0)");
    write_program("sleep 0.05; exit 5");
    const auto failed = fly(twins, jobs);
    ASSERT_TRUE(failed.ok()) << failed.error().message;
    EXPECT_EQ(flights(), 1U);
    for (const CellSummary& row : rows_of(*failed)) {
      EXPECT_THAT(row.problems, ElementsAre("exit code 5")) << row.cell;
    }
    EXPECT_THAT(failed->results.newest(), SizeIs(2));
    write_program();
    const auto again = fly(twins, jobs);
    ASSERT_TRUE(again.ok()) << again.error().message;
    EXPECT_EQ(flights(), 2U);
    ASSERT_THAT(again->results.newest(), SizeIs(2));
    for (const SweepResult* result : again->results.newest()) EXPECT_TRUE(result->completed());
  }
}

}  // namespace
}  // namespace overfly::server::experiments
