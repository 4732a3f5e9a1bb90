// Every command through the real program: results, faults and exit codes.
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

#include "tests/server/app/program.hpp"
#include "tests/support/support.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// A small world made by the program itself, a scenario over it, and whether EGL draws here.
class CommandLine : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    const Outcome made = overfly_program({"world",
                                          "synthesize",
                                          "--out",
                                          world(),
                                          "--size-m",
                                          "600",
                                          "--texel-m",
                                          "2",
                                          "--seed",
                                          "3"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const Json doctor = Json::parse(overfly_program({"doctor", "--json"}).out);
    draws_ = doctor.at("checks").at(0).at("level") == "ok";
    const Json scenario = {{"format_version", 1},
                           {"world", {{"manifest", world() + "/world.json"}}},
                           {"flight", {{"course", {{"length_m", 800}, {"leg_length_m", 300}}}}},
                           {"duration_s", 1},
                           {"camera", {{"width_px", 160}, {"height_px", 120}, {"rate_hz", 10}}},
                           {"estimators", {{{"name", "perfect"}, {"type", "perfect"}}}}};
    write_text(scenario_file(), scenario.dump());
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  void SetUp() override { ASSERT_NE(folder_, nullptr); }

  static std::string path(const std::string& name) { return (folder_->path() / name).string(); }
  static std::string world() { return path("world"); }
  static std::string scenario_file() { return path("small.json"); }
  static bool draws() { return draws_; }

 private:
  static TemporaryFolder* folder_;
  static bool draws_;
};
TemporaryFolder* CommandLine::folder_ = nullptr;
bool CommandLine::draws_ = false;

#define SKIP_WITHOUT_EGL() \
  if (!draws()) GTEST_SKIP() << "no EGL on this machine"

TEST_F(CommandLine, UsageFaultsExitWith2) {
  EXPECT_EQ(overfly_program({}).exit_code, 2);
  EXPECT_EQ(overfly_program({"fly"}).exit_code, 2);
  EXPECT_EQ(overfly_program({"run"}).exit_code, 2);
  EXPECT_EQ(overfly_program({"--help"}).exit_code, 0);
  EXPECT_THAT(overfly_program({"--version"}).out, HasSubstr("overfly 0."));
}

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

TEST_F(CommandLine, RunNamesTheFaultyField) {
  const Outcome run =
      overfly_program({"run", scenario_file(), "--out", path("r2"), "--set", "camera.fov_deg=190"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("camera.fov_deg = 190: must be in (0, 180)"));
  EXPECT_FALSE(fs::exists(path("r2")));
  EXPECT_EQ(overfly_program({"run", path("no.json"), "--out", path("r2")}).exit_code, 2);
  EXPECT_EQ(overfly_program({"run", scenario_file(), "--out", path("r2"), "--set", "x"}).exit_code,
            2);
}

/// Waits, without a limit of its own, until a run's frames file has so many lines.
bool wait_for_frames(RunningProgram& program, const fs::path& run, int wanted) {
  while (program.running()) {
    std::ifstream in(run / "frames.jsonl");
    const auto lines =
        std::count(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>(), '\n');
    if (lines >= wanted) return true;
    ::poll(nullptr, 0, 5);  // a child process tells nobody when it writes
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
}

TEST_F(CommandLine, EvaluateWritesMetricsOfARunThatNobodyFlies) {
  SKIP_WITHOUT_EGL();
  ASSERT_EQ(overfly_program({"run", scenario_file(), "--out", path("scored")}).exit_code, 0);
  const std::string file = path("scored/metrics.json");
  const std::string flown = read_text(file);
  fs::remove(file);
  const Outcome scored = overfly_program({"evaluate", "--run", path("scored")});
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  EXPECT_THAT(scored.out, HasSubstr("perfect"));
  EXPECT_EQ(read_text(file), flown) << "byte for byte what the run wrote";
  // While a process is at work there, nothing is written.
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

TEST_F(CommandLine, EvaluateScoresFilesOfOthersAndRefusesNonsense) {
  std::string truth;
  std::string estimate;
  for (int i = 0; i < 20; ++i) {
    const std::string t = std::to_string(i);
    const std::string y = std::to_string(i % 5);
    truth += t + " " + t + " " + y + " 0 0 0 0 1\n";
    estimate +=
        t + " " + std::to_string(2 * i) + " " + std::to_string(2 * (i % 5)) + " 0 0 0 0 1\n";
  }
  write_text(path("truth.tum"), truth);
  write_text(path("estimate.tum"), estimate);
  const Outcome scored = overfly_program({"evaluate",
                                          "--truth",
                                          path("truth.tum"),
                                          "--estimate",
                                          path("estimate.tum"),
                                          "--alignment",
                                          "sim3",
                                          "--alignment",
                                          "none",
                                          "--json"});
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  const Json alignments = Json::parse(scored.out).at("estimates").at(0).at("alignments");
  EXPECT_NEAR(alignments.at("sim3").at("scale").get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(alignments.at("sim3").at("position_rmse_m").get<double>(), 0.0, 1e-6);
  EXPECT_GT(alignments.at("none").at("position_rmse_m").get<double>(), 1.0);
  EXPECT_THAT(overfly_program({"evaluate",
                               "--truth",
                               path("truth.tum"),
                               "--estimate",
                               path("estimate.tum"),
                               "--alignment",
                               "all"})
                  .out,
              HasSubstr("sim3"));

  EXPECT_EQ(overfly_program({"evaluate", "--truth", path("truth.tum")}).exit_code, 2);
  EXPECT_EQ(overfly_program({"evaluate",
                             "--truth",
                             path("truth.tum"),
                             "--estimate",
                             path("estimate.tum"),
                             "--alignment",
                             "sim4"})
                .exit_code,
            2);
  write_text(path("broken.tum"), "0 1 2 three 0 0 0 1\n");
  const Outcome broken =
      overfly_program({"evaluate", "--truth", path("truth.tum"), "--estimate", path("broken.tum")});
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_THAT(broken.err, HasSubstr("broken.tum"));
}

/// Truth and estimates of others repeat stamps and are not always in order.
TEST_F(CommandLine, EvaluateOrdersPosesByTimeAndSaysSo) {
  const auto pose = [](int i, int x) {
    return std::to_string(i) + " " + std::to_string(x) + " " + std::to_string(i % 5) +
           " 0 0 0 0 1\n";
  };
  std::string truth;
  std::string estimate;
  for (int i = 0; i < 20; ++i) {
    truth += pose(i, i);
    if (i == 7) truth += pose(i, 900);  // the second of a time is left out
    estimate += pose(19 - i, 19 - i);
  }
  write_text(path("repeated.tum"), truth);
  write_text(path("backwards.tum"), estimate);
  const auto evaluate = [&](const std::string& association) {
    return overfly_program({"evaluate",
                            "--truth",
                            path("repeated.tum"),
                            "--estimate",
                            path("backwards.tum"),
                            "--alignment",
                            "none",
                            "--association",
                            association,
                            "--json"});
  };
  const Outcome scored = evaluate("interpolate");
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  const Json result = Json::parse(scored.out);
  const Json& entry = result.at("estimates").at(0);
  EXPECT_EQ(entry.at("matched"), 20);
  EXPECT_EQ(entry.at("alignments").at("none").at("position_max_m"), 0.0);
  const std::string repeated =
      path("repeated.tum") + ": 1 poses (first in line 9) repeat the time of an earlier line";
  const std::string moved =
      path("backwards.tum") + ": 19 poses (first in line 2) are out of time order";
  EXPECT_THAT(result.at("warnings").at(0).get<std::string>(), HasSubstr(repeated));
  EXPECT_THAT(entry.at("warnings").at(0).get<std::string>(), HasSubstr(moved));
  EXPECT_THAT(scored.err, HasSubstr("warning: " + repeated));
  EXPECT_THAT(scored.err, HasSubstr("warning: " + moved));

  const Outcome by_number = evaluate("index");
  EXPECT_EQ(by_number.exit_code, 2);
  EXPECT_THAT(by_number.err, HasSubstr("repeated.tum: contains unknown poses"));
}

TEST_F(CommandLine, WorldInfoDescribesAndNamesWhatIsMissing) {
  const Outcome info = overfly_program({"world", "info", world()});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_FALSE(info.out.empty());
  const Outcome missing = overfly_program({"world", "info", path("nowhere.json")});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("nowhere.json"));
  const Outcome small =
      overfly_program({"world", "synthesize", "--out", path("w2"), "--size-m", "1"});
  EXPECT_EQ(small.exit_code, 2);
  EXPECT_THAT(small.err, HasSubstr("size_m"));
}

TEST_F(CommandLine, NamesThatTheSystemRefusesAreErrors) {
  fs::create_symlink("loop", path("loop"));
  for (const std::string& name : {path("loop"), path(std::string(300, 'x'))}) {
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"world", "info", name},
          {"export", name, "--format", "euroc", "--out", path("exported")},
          {"serve", "--port", "0", "--scenarios", name, "--runs", path("served")}}) {
      const Outcome outcome = overfly_program(command);
      EXPECT_EQ(outcome.exit_code, command.front() == "serve" ? 2 : 1)
          << command.front() << ": " << outcome.err;
      EXPECT_THAT(outcome.err, HasSubstr("error: " + name));
    }
  }
}

TEST_F(CommandLine, RenderWritesOneImageWithDepth) {
  SKIP_WITHOUT_EGL();
  const Outcome drawn = overfly_program({"render",
                                         "--world",
                                         world(),
                                         "--lat",
                                         "39.35",
                                         "--lon",
                                         "-86.03",
                                         "--height-agl",
                                         "100",
                                         "--roll",
                                         "10",
                                         "--width",
                                         "320",
                                         "--height",
                                         "240",
                                         "--out",
                                         path("f.png"),
                                         "--depth",
                                         path("f.tif")});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_EQ(read_text(path("f.png")).substr(1, 3), "PNG");
  EXPECT_EQ(read_text(path("f.tif")).substr(0, 2), "II");
  EXPECT_EQ(overfly_program({"render",
                             "--world",
                             world(),
                             "--lat",
                             "95",
                             "--lon",
                             "0",
                             "--height-agl",
                             "100",
                             "--out",
                             path("g.png")})
                .exit_code,
            2);
}

TEST_F(CommandLine, ScenarioListsValidatesAndShows) {
  EXPECT_THAT(overfly_program({"scenario", "list"}).out, HasSubstr("course: The course"));
  EXPECT_EQ(overfly_program({"scenario", "validate", scenario_file()}).exit_code, 0);
  write_text(path("bad.json"), R"({"format_version": 2})");
  const Outcome bad = overfly_program({"scenario", "validate", path("bad.json")});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.err, HasSubstr("format_version = 2: must be 1"));
  EXPECT_THAT(bad.err, HasSubstr("world: must be given"));
  const Json shown = Json::parse(overfly_program({"scenario", "show", scenario_file()}).out);
  EXPECT_EQ(shown.at("pacing"), "lockstep");
  EXPECT_TRUE(Json::parse(overfly_program({"scenario", "schema"}).out).contains("$defs"));
}

TEST_F(CommandLine, DoctorFindsAFolderThatCannotBeWritten) {
  const Outcome well = overfly_program({"doctor", "--runs", path("runs")});
  EXPECT_THAT(well.out, HasSubstr("rasters (GDAL)"));
  EXPECT_EQ(well.exit_code, draws() ? 0 : 4) << well.out;
  write_text(path("file"), "");
  const Outcome ill = overfly_program({"doctor", "--runs", path("file")});
  EXPECT_EQ(ill.exit_code, 4);
  EXPECT_THAT(ill.out, HasSubstr("cannot be written to"));
}

TEST_F(CommandLine, BenchTellsWhatBothRenderersCost) {
  if (!draws()) GTEST_SKIP() << "OpenGL cannot draw here";
  const Outcome done =
      overfly_program({"bench", "--json", "--repetitions", "1", "--flight-s", "1"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const Json drawing = Json::parse(done.out).at("drawing");
  for (const char* ratio : {"camera_per_quad", "raycast_per_quad", "raycast_banked_per_quad"}) {
    ASSERT_TRUE(drawing.contains(ratio)) << ratio;
    EXPECT_GT(drawing.at(ratio).get<double>(), 0.0) << ratio;
  }
}

}  // namespace
}  // namespace overfly::testing
