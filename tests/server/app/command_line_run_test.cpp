// overfly run, and evaluate of run folders: results, errors, signals.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/motion/trajectory_io.hpp"
#include "tests/server/app/command_line_fixture.hpp"
#include "tests/server/app/program.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

TEST_F(CommandLine, RunWritesAFolderAndPrintsTheScores) {
  SKIP_WITHOUT_EGL();
  const Outcome run = overfly_program({"run", scenario_file(), "--out", path("r1")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("COMPLETED"));
  EXPECT_THAT(run.err, HasSubstr("100 % frame 11 of 11"));
  const Json metrics = Json::parse(read_text(path("r1/metrics.json")));
  EXPECT_EQ(metrics.at("camera").at("frames"), 11);

  const Outcome again = overfly_program({"run", scenario_file(), "--out", path("r1")});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("already contains a run"));

  const Outcome scored = overfly_program({"evaluate", "--run", path("r1"), "--json"});
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  EXPECT_EQ(
      Json::parse(scored.out).at("estimators").at("perfect").at("alignments").at("init_scale"),
      metrics.at("estimators").at("perfect").at("alignments").at("init_scale"));

  const Outcome files = overfly_program({"evaluate",
                                         "--truth",
                                         path("r1/truth.tum"),
                                         "--estimate",
                                         path("r1/estimates/perfect.tum"),
                                         "--alignment",
                                         "init_scale",
                                         "--json"});
  ASSERT_EQ(files.exit_code, 0) << files.err;
  const Json alignment =
      Json::parse(files.out).at("estimates").at(0).at("alignments").at("init_scale");
  EXPECT_LT(alignment.at("position_rmse_m").get<double>(), 1e-6);
}

TEST_F(CommandLine, RunNamesTheInvalidField) {
  const Outcome run =
      overfly_program({"run", scenario_file(), "--out", path("r2"), "--set", "camera.fov_deg=190"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("camera.fov_deg = 190: must be in (0, 180)"));
  EXPECT_FALSE(fs::exists(path("r2")));
  EXPECT_EQ(overfly_program({"run", path("no.json"), "--out", path("r2")}).exit_code, 2);
  EXPECT_EQ(overfly_program({"run", scenario_file(), "--out", path("r2"), "--set", "x"}).exit_code,
            2);
}

TEST_F(CommandLine, RunTakesTheFolderOfARunThatFailedAtItsStart) {
  const auto run_from = [&](const std::string& start) {
    return overfly_program(
        {"run", scenario_file(), "--out", path("again"), "--set", "start_s=" + start});
  };
  const Outcome late = run_from("1000");
  ASSERT_EQ(late.exit_code, 2) << late.err;
  EXPECT_EQ(Json::parse(read_text(path("again/manifest.json"))).at("status"), "failed");
  std::ofstream(path("again/notes.txt")) << "of the user";
  EXPECT_EQ(run_from("0").exit_code, 2);
  EXPECT_EQ(read_text(path("again/notes.txt")), "of the user");
  fs::remove(path("again/notes.txt"));
  SKIP_WITHOUT_EGL();
  const Outcome right = run_from("0");
  ASSERT_EQ(right.exit_code, 0) << right.err;
  EXPECT_EQ(Json::parse(read_text(path("again/manifest.json"))).at("status"), "completed");
  EXPECT_EQ(run_from("0").exit_code, 2) << "has frames";
}

/// Waits, without a time limit, until a run's frames file has this number of lines.
bool wait_for_frames(RunningProgram& program, const fs::path& run, int wanted) {
  while (program.running()) {
    std::ifstream in(run / "frames.jsonl");
    const auto lines =
        std::count(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>(), '\n');
    if (lines >= wanted) return true;
    ::poll(nullptr, 0, 5);  // there is no event for a child process that writes
  }
  return false;
}

TEST_F(CommandLine, KilledRunLeavesAReadableFolderMarkedInterrupted) {
  SKIP_WITHOUT_EGL();
  const TemporaryFolder output;
  {
    RunningProgram program({"run",
                            scenario_file(),
                            "--out",
                            path("killed"),
                            "--set",
                            "duration_s=30",
                            "--set",
                            "camera.rate_hz=100"},
                           output.path());
    ASSERT_TRUE(wait_for_frames(program, path("killed"), 10)) << program.err();
    program.signal(SIGKILL);
    EXPECT_EQ(program.wait(), -1);
  }
  const Json manifest = Json::parse(read_text(path("killed/manifest.json")));
  EXPECT_EQ(manifest.at("status"), "running");
  const Outcome scored = overfly_program({"evaluate", "--run", path("killed"), "--json"});
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  const Json metrics = Json::parse(scored.out);
  EXPECT_EQ(metrics.at("status"), "interrupted");
  EXPECT_GE(metrics.at("camera").at("frames").get<int>(), 10);
  const Json written = Json::parse(read_text(path("killed/metrics.json")));
  EXPECT_EQ(written.at("camera"), metrics.at("camera"));
  EXPECT_GT(written.at("estimators").at("perfect").at("alignments").size(), 1U)
      << "all alignments, not only those that were printed";
  EXPECT_FALSE(fs::exists(path("killed/.running")));
  EXPECT_GT(read_trajectory(path("killed/truth.tum")).value().trajectory.size(), 9U);
  EXPECT_TRUE(fs::exists(path("killed/estimates/perfect.tum")));
}

TEST_F(CommandLine, EvaluateWritesMetricsOfARunThatIsNotInUse) {
  SKIP_WITHOUT_EGL();
  ASSERT_EQ(overfly_program({"run", scenario_file(), "--out", path("scored")}).exit_code, 0);
  const std::string file = path("scored/metrics.json");
  const std::string flown = read_text(file);
  fs::remove(file);
  const Outcome scored = overfly_program({"evaluate", "--run", path("scored")});
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  EXPECT_THAT(scored.out, HasSubstr("perfect"));
  EXPECT_EQ(read_text(file), flown) << "the same bytes as written by the run";
  // While another process uses the folder, nothing is written.
  write_text(file, "{}");
  const int lock = ::open(path("scored/.running").c_str(), O_RDWR | O_CREAT, 0644);
  ASSERT_EQ(::flock(lock, LOCK_EX | LOCK_NB), 0);
  const Outcome refused = overfly_program({"evaluate", "--run", path("scored")});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("is in use by another process"));
  EXPECT_EQ(read_text(file), "{}");
  ::close(lock);
}

TEST_F(CommandLine, SignalCancelsARunCleanly) {
  SKIP_WITHOUT_EGL();
  const TemporaryFolder output;
  RunningProgram program({"run",
                          scenario_file(),
                          "--out",
                          path("cancelled"),
                          "--set",
                          "duration_s=30",
                          "--set",
                          "camera.rate_hz=100"},
                         output.path());
  ASSERT_TRUE(wait_for_frames(program, path("cancelled"), 5)) << program.err();
  program.signal(SIGINT);
  EXPECT_EQ(program.wait(), 3);
  EXPECT_THAT(program.err(), HasSubstr("cancelled after frame"));
  const Json manifest = Json::parse(read_text(path("cancelled/manifest.json")));
  EXPECT_EQ(manifest.at("status"), "cancelled");
  EXPECT_TRUE(fs::exists(path("cancelled/metrics.json")));
}

}  // namespace
}  // namespace overfly::testing
