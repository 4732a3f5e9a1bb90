// Frame caches by the program itself: sweeps with and without one, at once, killed, and options.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/server/app/command_line_fixture.hpp"
#include "tests/server/app/program.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

class FrameCacheCommand : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    write_text(file(), R"({"format_version": 1, "scenario": ")" + scenario_file() + R"(",
      "set": {"camera.sensor": {"shot_noise": true, "read_noise_e": 10}, "recording.frames": true},
      "axes": [{"path": "flight.course.airspeed_m_s", "values": [15, 20]}],
      "repeats": {"most": 3}})");
  }
  static std::string file() { return path("cached.json"); }
  static std::vector<std::string> sweep(const std::string& out,
                                        const std::vector<std::string>& options = {}) {
    std::vector<std::string> words{"sweep", file(), "--out", path(out), "--jobs", "1"};
    words.insert(words.end(), options.begin(), options.end());
    return words;
  }
  /// Every file of a sweep's runs but their timings, by its path.
  static std::vector<std::pair<std::string, std::string>> runs_of(const std::string& out) {
    std::vector<std::pair<std::string, std::string>> files;
    const fs::path runs = fs::path(path(out)) / "runs";
    for (const auto& entry : fs::recursive_directory_iterator(runs)) {
      const fs::path name = entry.path().filename();
      if (!entry.is_regular_file() || name == "timings.json" || name == "created.json") continue;
      files.emplace_back(fs::relative(entry.path(), runs).string(), read_text(entry.path()));
    }
    std::sort(files.begin(), files.end());
    return files;
  }
  static std::size_t pictures_in(const std::string& folder) {
    std::size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(path(folder))) {
      count += entry.path().extension() == ".frame" ? 1 : 0;
    }
    return count;
  }
};

TEST_F(FrameCacheCommand, ASweepRendersItsPicturesOnce) {
  const Outcome with = overfly_program(sweep("f1"));
  ASSERT_EQ(with.exit_code, 0) << with.err;
  const std::size_t pictures = pictures_in("f1/frame_cache");
  ASSERT_GT(pictures, 10U);
  EXPECT_THAT(with.err,
              HasSubstr(std::to_string(2 * pictures) + " of " + std::to_string(3 * pictures) +
                        " pictures were read from the frame cache"));
  const Outcome without = overfly_program(sweep("f2", {"--frame-cache-gib", "0"}));
  ASSERT_EQ(without.exit_code, 0) << without.err;
  EXPECT_FALSE(fs::exists(path("f2/frame_cache")));
  EXPECT_THAT(without.err, Not(HasSubstr("frame cache")));
  const auto runs = runs_of("f1");
  EXPECT_EQ(runs.size(), runs_of("f2").size());
  EXPECT_TRUE(runs == runs_of("f2"));
}

TEST_F(FrameCacheCommand, SweepsThatRunAtOnceShareAFolder) {
  const std::vector<std::string> options{"--frame-cache", path("shared")};
  RunningProgram first(sweep("f3", options), path(""));
  const Outcome second = overfly_program(sweep("f4", options));
  EXPECT_EQ(first.wait(), 0) << first.err();
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_FALSE(fs::exists(path("f3/frame_cache")));
  EXPECT_TRUE(runs_of("f3") == runs_of("f4"));
}

TEST_F(FrameCacheCommand, AWorkerKeepsThePicturesOfItsFlights) {
  RunningProgram sweep({"sweep", file(), "--out", path("f6"), "--executor", "folder"}, path(""));
  while (sweep.running() && !fs::exists(path("f6/sweep.json"))) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const Outcome worker = overfly_program({"sweep",
                                          "work",
                                          path("f6"),
                                          "--jobs",
                                          "1",
                                          "--idle-s",
                                          "30",
                                          "--frame-cache",
                                          path("node")});
  EXPECT_EQ(worker.exit_code, 0) << worker.err;
  EXPECT_EQ(sweep.wait(), 0) << sweep.err();
  EXPECT_FALSE(fs::exists(path("f6/frame_cache")));
  std::size_t read = 0;
  for (const auto& run : fs::directory_iterator(path("f6/runs"))) {
    const Json timings = Json::parse(read_text(run.path() / "timings.json"));
    read += timings.at("frame_cache").at("read").get<std::size_t>();
  }
  EXPECT_GT(pictures_in("node"), 10U);
  EXPECT_EQ(read, 2 * pictures_in("node")) << "two of three repeats read them";
  ASSERT_EQ(overfly_program(FrameCacheCommand::sweep("f7", {"--frame-cache-gib", "0"})).exit_code,
            0);
  EXPECT_TRUE(runs_of("f6") == runs_of("f7"));
}

TEST_F(FrameCacheCommand, AKilledFlightLeavesACacheThatCanBeUsed) {
  const auto run = [](const std::string& out) {
    return std::vector<std::string>{
        "run", scenario_file(), "--out", path(out), "--frame-cache", path("killed")};
  };
  {
    RunningProgram killed(run("r1"), path(""));
    while (killed.running() && (!fs::exists(path("killed")) || pictures_in("killed") < 3)) {
    }
    killed.signal(SIGKILL);
    killed.wait();
  }
  const std::size_t known = pictures_in("killed");
  const Outcome flown = overfly_program(run("r2"));
  ASSERT_EQ(flown.exit_code, 0) << flown.err;
  EXPECT_THAT(flown.err, Not(HasSubstr("warning: frame cache")));
  const Json use = Json::parse(read_text(path("r2/timings.json"))).at("frame_cache");
  EXPECT_EQ(use.at("read"), known);
  EXPECT_EQ(use.at("damaged"), 0);
}

TEST_F(FrameCacheCommand, WarnsOnceOfAFolderThatCannotBeUsed) {
  write_text(path("blocked"), "a file");
  const Outcome flown = overfly_program(
      {"run", scenario_file(), "--out", path("r3"), "--quiet", "--frame-cache", path("blocked")});
  ASSERT_EQ(flown.exit_code, 0) << flown.err;
  EXPECT_THAT(flown.err, HasSubstr("warning: frame cache: " + path("blocked")));
  EXPECT_EQ(flown.err.find("frame cache", flown.err.find("frame cache") + 1), std::string::npos);
}

TEST_F(FrameCacheCommand, NamesOptionsBeyondTheirLimits) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {sweep("f5", {"--frame-cache-gib", "-1"}), "--frame-cache-gib"},
      {sweep("f5", {"--frame-cache-gib", "much"}), "--frame-cache-gib"},
      {sweep("f5", {"--executor", "slurm", "--frame-cache-gib", "2"}),
       "--frame-cache-gib: needs --frame-cache with Slurm"},
      {{"sweep", file(), "--out", path("f5"), "--executor", "folder", "--frame-cache", path("x")},
       "--frame-cache: is an option of the workers with --executor folder"},
      {{"sweep", "work", path("f5"), "--frame-cache-gib", "2"}, "--frame-cache"}};
  for (const auto& [words, message] : cases) {
    const Outcome outcome = overfly_program(words);
    EXPECT_EQ(outcome.exit_code, 2) << message;
    EXPECT_THAT(outcome.err, HasSubstr(message));
  }
  EXPECT_FALSE(fs::exists(path("f5")));
}

}  // namespace
}  // namespace overfly::testing
