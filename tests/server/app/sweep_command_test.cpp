// overfly sweep: a whole sweep by the program itself, cancelled and killed in between.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "tests/server/app/command_line_fixture.hpp"
#include "tests/server/app/program.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

class SweepCommand : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    write_text(file(), R"({"format_version": 1, "scenario": ")" + scenario_file() + R"(",
      "axes": [{"path": "flight.course.airspeed_m_s", "label": "Airspeed", "unit": "m/s",
                "values": [15, 20, 25]}],
      "repeats": {"most": 2}})");
  }
  static std::string file() { return path("sweep.json"); }
  static std::vector<std::string> arguments(const std::string& out) {
    return {"sweep", file(), "--out", path(out), "--jobs", "1", "--json"};
  }
  static std::size_t lines(const std::string& out) {
    const fs::path results = fs::path(path(out)) / "results.jsonl";
    if (!fs::exists(results)) return 0;
    const std::string text = read_text(results);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
  /// Waits until some flights are over. @return whether they are, before the program's end
  static bool wait_for_lines(RunningProgram& program, const std::string& out, std::size_t count) {
    while (lines(out) < count) {
      if (!program.running()) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }
  /// The sweep is finished as if nothing had happened, and no flight was recorded twice.
  static void expect_continued(const std::string& out) {
    const Outcome rest = overfly_program(arguments(out));
    ASSERT_EQ(rest.exit_code, 0) << rest.err;
    EXPECT_EQ(lines(out), 6U);
    const Json rows = Json::parse(rest.out);
    ASSERT_EQ(rows.size(), 3U);
    for (const Json& row : rows) {
      EXPECT_EQ(row.at("flights"), 2);
      EXPECT_EQ(row.at("successes"), 2);
    }
  }
};

TEST_F(SweepCommand, FliesForAParentThatIgnoresTheEndOfItsChildren) {
  SKIP_WITHOUT_EGL();
  const TemporaryFolder output;
  std::signal(SIGCHLD, SIG_IGN);  // exec keeps it
  RunningProgram program(arguments("s0"), output.path());
  std::signal(SIGCHLD, SIG_DFL);
  EXPECT_EQ(program.wait(), 0) << program.err();
  EXPECT_EQ(lines("s0"), 6U);
}

TEST_F(SweepCommand, FliesTheCellsAndPrintsATable) {
  SKIP_WITHOUT_EGL();
  const Outcome planned = overfly_program({"sweep", file(), "--out", path("s1"), "--dry-run"});
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  EXPECT_THAT(planned.out, HasSubstr("3 cells, 1 estimator, at most 6 flights; 6 to be flown"));
  EXPECT_FALSE(fs::exists(path("s1")));
  const Outcome flown = overfly_program({"sweep", file(), "--out", path("s1"), "--jobs", "2"});
  ASSERT_EQ(flown.exit_code, 0) << flown.err;
  EXPECT_THAT(flown.out, HasSubstr("| Airspeed [m/s] | estimator |"));
  EXPECT_THAT(flown.out, HasSubstr("2 COMPLETED"));
  EXPECT_THAT(flown.err, HasSubstr("100 % flight 6 of 6"));
  EXPECT_EQ(read_text(path("s1/summary.md")), flown.out);
  // A run of the sweep is a run like any other.
  const fs::path run = fs::directory_iterator(path("s1/runs"))->path();
  EXPECT_EQ(overfly_program({"evaluate", "--run", run.string()}).exit_code, 0);
  const Outcome again = overfly_program({"sweep", file(), "--out", path("s1"), "--dry-run"});
  EXPECT_THAT(again.out, HasSubstr("; 0 to be flown"));
}

TEST_F(SweepCommand, ContinuesAfterItWasCancelled) {
  SKIP_WITHOUT_EGL();
  {
    RunningProgram sweep(arguments("s2"), path(""));
    if (!wait_for_lines(sweep, "s2", 1)) FAIL() << sweep.err();
    sweep.signal(SIGINT);
    EXPECT_EQ(sweep.wait(), 3) << sweep.err();
    EXPECT_THAT(sweep.err(), HasSubstr("the same command continues"));
  }
  expect_continued("s2");
}

TEST_F(SweepCommand, ContinuesAfterItWasKilled) {
  SKIP_WITHOUT_EGL();
  for (const std::size_t flights : {1U, 3U}) {
    RunningProgram sweep(arguments("s3"), path(""));
    if (!wait_for_lines(sweep, "s3", flights)) FAIL() << sweep.err();
    sweep.signal(SIGKILL);
    EXPECT_EQ(sweep.wait(), -1);
  }
  expect_continued("s3");
}

/// The process of a worker, and the folder with its output.
class Worker {
 public:
  explicit Worker(const std::string& sweep)
      : program_({"sweep", "work", sweep, "--jobs", "1", "--idle-s", "30"}, folder_.path()) {}
  RunningProgram* operator->() { return &program_; }

 private:
  TemporaryFolder folder_;
  RunningProgram program_;
};

TEST_F(SweepCommand, IsFlownByWorkersThatComeAndGo) {
  SKIP_WITHOUT_EGL();
  RunningProgram sweep({"sweep", file(), "--out", path("s7"), "--executor", "folder"}, path(""));
  while (sweep.running() && !fs::exists(path("s7/sweep.json"))) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  Worker first(path("s7"));
  if (!wait_for_lines(sweep, "s7", 1)) FAIL() << sweep.err() << first->err();
  first->signal(SIGTERM);
  EXPECT_EQ(first->wait(), 3) << first->err();
  Worker second(path("s7"));
  EXPECT_EQ(second->wait(), 0) << second->err();
  EXPECT_THAT(second->out(), HasSubstr("delivered"));
  EXPECT_EQ(sweep.wait(), 0) << sweep.err();
  EXPECT_THAT(sweep.err(), HasSubstr("workers fly it: overfly sweep work " + path("s7")));
  expect_continued("s7");
}

/// A file system of its own that can be filled.
class SmallDisk {
 public:
  explicit SmallDisk(std::string folder) : folder_(std::move(folder)) {
    fs::create_directories(folder_);
    mounted_ = ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, "size=64m") == 0;
  }
  ~SmallDisk() {
    if (mounted_) ::umount2(folder_.c_str(), MNT_DETACH);
  }
  [[nodiscard]] bool mounted() const { return mounted_; }
  void fill() const {
    std::ofstream filler(folder_ + "/filler", std::ios::app);
    const std::string piece(4096, 'x');
    while (filler << piece << std::flush) {
    }
  }
  void free() const { fs::remove(folder_ + "/filler"); }

 private:
  std::string folder_;
  bool mounted_ = false;
};

/// Nothing is lost: flights that failed for it are flown again, finished ones are delivered later.
TEST_F(SweepCommand, GoesOnWhenAFullDiskHasSpaceAgain) {
  SKIP_WITHOUT_EGL();
  const SmallDisk disk(path("disk"));
  if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system needs root";
  RunningProgram sweep({"sweep", file(), "--out", path("disk/s"), "--executor", "folder"},
                       path(""));
  while (sweep.running() && !fs::exists(path("disk/s/sweep.json"))) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  Worker worker(path("disk/s"));
  if (!wait_for_lines(sweep, "disk/s", 1)) FAIL() << sweep.err() << worker->err();
  while (worker->running() &&
         worker->err().find("No space left on device; tried again") == std::string::npos) {
    disk.fill();  // Again: a flight that ends frees some.
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(worker->running()) << worker->err();
  disk.free();
  // The sweep command ends if it was it that could not write; otherwise it goes on by itself.
  if (sweep.wait() != 0) {
    EXPECT_THAT(sweep.err(), HasSubstr("No space left on device"));
  }
  expect_continued("disk/s");
}

TEST_F(SweepCommand, ComparesTwoSweepsFlightByFlight) {
  SKIP_WITHOUT_EGL();
  for (const char* out : {"s5", "s6"}) ASSERT_EQ(overfly_program(arguments(out)).exit_code, 0);
  // One flight of the candidate was lost.
  std::string results = read_text(path("s5/results.jsonl"));
  results.replace(results.find("COMPLETED"), 9, "LOST");
  write_text(path("s5/results.jsonl"), results);
  const auto compare = [](std::vector<std::string> conditions) {
    std::vector<std::string> words{"compare", path("s5"), path("s6"), "--junit", path("junit.xml")};
    for (const std::string& condition : conditions) {
      words.insert(words.end(), {"--fail-if", condition});
    }
    return overfly_program(words);
  };
  const Outcome good =
      compare({"success_rate < 0.8", "max(position_rmse_m) > 2 * baseline + 0.001"});
  EXPECT_EQ(good.exit_code, 0) << good.out << good.err;
  EXPECT_THAT(good.out, HasSubstr("6 flights in both sweeps; 0 without a pair"));
  EXPECT_THAT(read_text(path("junit.xml")), HasSubstr(R"(tests="2" failures="0" errors="0")"));
  const Outcome bad = compare({"success_rate < baseline", "mean(position_rmse_m) > 1"});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.out, HasSubstr("FAILED  success_rate < baseline  (0.8333"));
  EXPECT_THAT(bad.out, HasSubstr("passed  mean(position_rmse_m) > 1"));
  const std::string junit = read_text(path("junit.xml"));
  EXPECT_THAT(junit, HasSubstr(R"(tests="2" failures="1" errors="0")"));
  EXPECT_THAT(junit, HasSubstr(R"(name="success_rate &lt; baseline"><failure message="0.8333)"));
  EXPECT_EQ(compare({"success < 1"}).exit_code, 2);
  const Outcome none =
      overfly_program({"compare", path("s5"), path("absent"), "--fail-if", "success_rate < 1"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("absent: is no folder of a sweep (sweep.json is missing)"));
  const Outcome unwritten = overfly_program({"compare",
                                             path("s5"),
                                             path("s6"),
                                             "--fail-if",
                                             "success_rate < 0.5",
                                             "--junit",
                                             path("absent/junit.xml")});
  EXPECT_EQ(unwritten.exit_code, 2) << "1 says that a condition holds";
  EXPECT_THAT(unwritten.err, HasSubstr("--junit: "));
  // Other seeds: no flight has a pair.
  fs::remove(path("junit.xml"));
  results = read_text(path("s5/results.jsonl"));
  for (std::size_t at = 0; (at = results.find("\"seed\":", at)) != std::string::npos; at += 9) {
    results.insert(at + 7, "9");
  }
  write_text(path("s5/results.jsonl"), results);
  const Outcome unpaired = compare({"success_rate < 0.8"});
  EXPECT_EQ(unpaired.exit_code, 2);
  EXPECT_THAT(unpaired.err, HasSubstr("no flight was completed in both"));
  EXPECT_THAT(read_text(path("junit.xml")), HasSubstr(R"(tests="1" failures="0" errors="1")"));
}

TEST_F(SweepCommand, AnEstimatorWhoseProgramIsMissingIsNoResult) {
  const std::string program = path("late_vo");
  write_text(path("late.json"),
             R"({"format_version": 1, "scenario": ")" + scenario_file() + R"(",
    "axes": [], "retries": 0,
    "estimators": [{"name": "late", "type": "process", "command": [")" +
                 program + R"("]}]})");
  const std::vector<std::string> words{"sweep", path("late.json"), "--out", path("s9")};
  std::vector<std::string> dry = words;
  dry.emplace_back("--dry-run");
  const std::string reason = "command[0] = '" + program + "': there is no such file";
  const Outcome planned = overfly_program(dry);
  EXPECT_EQ(planned.exit_code, 0) << planned.err;
  EXPECT_THAT(planned.err, HasSubstr("warning: estimator late: " + reason));
  for (int call = 0; call < 2; ++call) {  // The second one tries again.
    const Outcome flown = overfly_program(words);
    EXPECT_EQ(flown.exit_code, 5);
    EXPECT_THAT(flown.err,
                AllOf(HasSubstr("warning: estimator late never ran: "), HasSubstr(reason)));
    EXPECT_THAT(flown.out, HasSubstr("1 not flown"));
    EXPECT_THAT(flown.out, Not(HasSubstr("CRASHED")));
    EXPECT_EQ(Json::parse(read_text(path("s9/progress.json"))).at("flown"), 1);
  }
}

TEST_F(SweepCommand, DoesNotMixItsFilesIntoARun) {
  fs::create_directories(path("run"));
  write_text(path("run/manifest.json"), "{}");
  const Outcome sweep = overfly_program({"sweep", file(), "--out", path("run")});
  EXPECT_EQ(sweep.exit_code, 2);
  EXPECT_THAT(sweep.err, HasSubstr("run: is no folder of a sweep"));
  const Outcome envelope = overfly_program(
      {"envelope", file(), "--out", path("run"), "--along", "flight.course.airspeed_m_s"});
  EXPECT_EQ(envelope.exit_code, 2);
  EXPECT_FALSE(fs::exists(path("run/runs")));
}

TEST_F(SweepCommand, DoesNotReplaceTheFileThatItReads) {
  fs::create_directories(path("own"));
  fs::copy_file(file(), path("own/sweep.json"));
  const std::string before = read_text(path("own/sweep.json"));
  const Outcome sweep = overfly_program({"sweep", path("own/sweep.json"), "--out", path("own")});
  EXPECT_EQ(sweep.exit_code, 2);
  EXPECT_THAT(sweep.err, HasSubstr("own/sweep.json: is the file of sweep"));
  const Outcome envelope = overfly_program({"envelope",
                                            path("own/sweep.json"),
                                            "--out",
                                            path("own"),
                                            "--along",
                                            "flight.course.airspeed_m_s"});
  EXPECT_EQ(envelope.exit_code, 2);
  EXPECT_EQ(read_text(path("own/sweep.json")), before);
  EXPECT_FALSE(fs::exists(path("own/runs")));
}

TEST_F(SweepCommand, TablesAndComparisonsDoNotReplaceWhatTheyRead) {
  fs::create_directories(path("read"));
  for (const char* name : {"read/sweep.json", "read/results.jsonl", "read/published.json"}) {
    write_text(path(name), "{}");
    const Outcome table = overfly_program(
        {"table", path("read"), "--published", path("read/published.json"), "--out", path(name)});
    EXPECT_EQ(table.exit_code, 2) << name;
    EXPECT_THAT(table.err, HasSubstr("must be another")) << name;
    EXPECT_EQ(read_text(path(name)), "{}");
  }
  const Outcome compare = overfly_program({"compare",
                                           path("absent"),
                                           path("read"),
                                           "--fail-if",
                                           "success_rate < 1",
                                           "--junit",
                                           path("read/results.jsonl")});
  EXPECT_EQ(compare.exit_code, 2);
  EXPECT_THAT(compare.err, HasSubstr("must be another"));
}

TEST_F(SweepCommand, NamesOptionsThatDoNotFitTogether) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"sweep", "--out", path("s8")}, "sweep: a sweep file is required"},
      {{"sweep", file()}, "--out: is required"},
      {{"sweep", file(), "--out", path("s8"), "--jobs", "257"},
       "--jobs = 257: must be in [0, 256] without Slurm"},
      {{"sweep", file(), "--out", path("s8"), "--executor", "folder", "--jobs", "2"},
       "--jobs: is an option of the workers"},
      {{"sweep", file(), "--out", path("s8"), "--slurm-option=--partition=x"},
       "--slurm-option: needs --executor slurm"},
      {{"sweep", file(), "--out", path("s8"), "--lease-s", "20"},
       "--lease-s: needs --executor folder or slurm"},
      {{"sweep", "work", path("absent")}, "is no folder of a sweep (sweep.json is missing)"}};
  for (const auto& [words, message] : cases) {
    const Outcome outcome = overfly_program(words);
    EXPECT_EQ(outcome.exit_code, 2) << message;
    EXPECT_THAT(outcome.err, HasSubstr(message));
  }
  EXPECT_FALSE(fs::exists(path("s8")));
}

TEST_F(SweepCommand, NamesWhatIsInvalid) {
  write_text(file(),
             R"({"format_version": 1, "scenario": ")" + scenario_file() +
                 R"(", "axes": [{"path": "flight.course.airspeed_m_s", "values": [-1]}]})");
  const Outcome sweep = overfly_program({"sweep", file(), "--out", path("s4")});
  EXPECT_EQ(sweep.exit_code, 2);
  EXPECT_THAT(sweep.err, HasSubstr("flight.course.airspeed_m_s = -1"));
  EXPECT_FALSE(fs::exists(path("s4")));
}

}  // namespace
}  // namespace overfly::testing
