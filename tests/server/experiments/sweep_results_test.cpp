// results.jsonl: what a kill, another version or a damaged disk leaves of it.
#include "server/experiments/sweep_results.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/support.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;

SweepResult flown(const std::string& key, evaluation::Outcome outcome) {
  SweepResult result;
  result.key = key;
  result.cell = {{"flight.course.airspeed_m_s", 25}};
  result.repeat = 3;
  result.seed = 18446744073709551615U;
  result.estimator = "feature";
  result.run = "runs/a";
  result.outcome = outcome;
  result.duration_s = 1.5;
  return result;
}

TEST(SweepResults, AreReadAsTheyWereWritten) {
  const TemporaryFolder folder;
  auto results = SweepResults::open(folder.path());
  ASSERT_TRUE(results.ok());
  ASSERT_TRUE(results->add(flown("a", evaluation::Outcome::kLost)).ok());
  SweepResult failed = flown("b", evaluation::Outcome::kLost);
  failed.error = "exit code 1: \"no\nmemory\"";
  ASSERT_TRUE(results->add(failed).ok());
  ASSERT_TRUE(results->add(flown("a", evaluation::Outcome::kCompleted)).ok());
  const auto again = SweepResults::open(folder.path());
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(again->by_key().size(), 2U);
  const SweepResult& a = *again->find("a");
  EXPECT_TRUE(a.completed());
  EXPECT_EQ(a.outcome, evaluation::Outcome::kCompleted) << "the later line counts";
  EXPECT_EQ(a.cell, flown("a", {}).cell);
  EXPECT_EQ(a.repeat, 3);
  EXPECT_EQ(a.seed, 18446744073709551615U);
  EXPECT_EQ(a.run, "runs/a");
  EXPECT_FALSE(again->find("b")->completed());
  EXPECT_EQ(again->find("b")->error, failed.error);
  EXPECT_EQ(again->find("c"), nullptr);
}

TEST(SweepResults, WithdrawnOnesAreNotTheNewest) {
  const TemporaryFolder folder;
  auto results = SweepResults::open(folder.path());
  const SweepResult lost = flown("a", evaluation::Outcome::kLost);
  ASSERT_TRUE(results->add(lost).ok());
  ASSERT_TRUE(results->withdraw(lost).ok());
  for (const SweepResults& read : {*results, *SweepResults::read(folder.path())}) {
    EXPECT_TRUE(read.newest().empty());
    EXPECT_FALSE(read.has(lost));
    ASSERT_NE(read.find("a"), nullptr) << "its flight is still known";
    EXPECT_TRUE(read.find("a")->completed());
    EXPECT_EQ(read.unreadable_lines(), 0);
  }
  ASSERT_TRUE(results->add(lost).ok());
  EXPECT_EQ(SweepResults::read(folder.path())->newest().size(), 1U);
}

/// Cut at every byte, the file keeps its whole lines and can be continued.
TEST(SweepResults, SurviveAKillAtEveryByte) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "results.jsonl";
  {
    auto results = SweepResults::open(folder.path());
    ASSERT_TRUE(results->add(flown("a", evaluation::Outcome::kLost)).ok());
    ASSERT_TRUE(results->add(flown("b", evaluation::Outcome::kLost)).ok());
  }
  const std::string whole = read_text(file);
  const std::size_t first = whole.find('\n') + 1;
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    write_text(file, whole.substr(0, size));
    auto results = SweepResults::open(folder.path());
    ASSERT_TRUE(results.ok());
    const std::size_t lines = size < first ? 0U : (size < whole.size() ? 1U : 2U);
    ASSERT_EQ(results->by_key().size(), lines) << size;
    EXPECT_EQ(results->unreadable_lines(), 0);
    ASSERT_TRUE(results->add(flown("c", evaluation::Outcome::kReset)).ok());
    const auto continued = SweepResults::open(folder.path());
    ASSERT_EQ(continued->by_key().size(), lines + 1) << size;
    ASSERT_EQ(continued->unreadable_lines(), 0) << size;
  }
}

TEST(SweepResults, OtherLinesAreCountedAndKept) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "results.jsonl";
  auto results = SweepResults::open(folder.path());
  ASSERT_TRUE(results->add(flown("a", evaluation::Outcome::kLost)).ok());
  const std::string good = read_text(file);
  std::string unknown = good;
  unknown.replace(unknown.find("LOST"), 4, "SAD!");
  const std::string text = std::string(100, '[') + "\n[1,2]\n\xFF\n" + unknown + good +
                           R"({"key":"x","repeat":1e400})" + "\n";
  write_text(file, text);
  const auto read = SweepResults::open(folder.path());
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->by_key().size(), 1U);
  EXPECT_EQ(read->unreadable_lines(), 5);
  EXPECT_EQ(read_text(file), text);
}

TEST(SweepResults, ARunOutsideTheSweepIsNotRead) {
  const TemporaryFolder folder;
  auto results = SweepResults::open(folder.path());
  ASSERT_TRUE(results->add(flown("a", evaluation::Outcome::kLost)).ok());
  const std::string good = read_text(folder.path() / "results.jsonl");
  for (const char* run : {"/etc", "../other/runs/a", "runs/../..", "runs/", "runs/a/b", "a", ""}) {
    std::string line = good;
    line.replace(line.find("runs/a"), 6, run);
    write_text(folder.path() / "results.jsonl", line);
    const auto read = SweepResults::read(folder.path());
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_TRUE(read->by_key().empty()) << run;
    EXPECT_EQ(read->unreadable_lines(), 1) << run;
  }
}

}  // namespace
}  // namespace overfly::server::experiments
