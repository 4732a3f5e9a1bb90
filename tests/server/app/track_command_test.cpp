// `overfly track` through the real program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/motion/trajectory_io.hpp"
#include "tests/server/app/program.hpp"
#include "tests/support/support.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

/// A flight of 2 s as a PNG data set, made once.
class TrackCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    data_ = new TemporaryFolder;
    const fs::path& folder = data_->path();
    const Outcome world = overfly_program({"world",
                                           "synthesize",
                                           "--out",
                                           (folder / "world").string(),
                                           "--size-m",
                                           "600",
                                           "--texel-m",
                                           "2"});
    ASSERT_EQ(world.exit_code, 0) << world.err;
    const Json scenario = {
        {"format_version", 1},
        {"world", {{"manifest", (folder / "world" / "world.json").string()}}},
        {"flight", {{"course", {{"length_m", 800}, {"leg_length_m", 300}}}}},
        {"duration_s", 2},
        {"camera", {{"width_px", 160}, {"height_px", 120}, {"rate_hz", 10}}},
        {"renderer", {{"camera", "raycast"}}},
        {"estimators",
         {{{"name", "few"}, {"type", "feature"}, {"parameters", {{"features", 300}}}},
          {{"name", "many"}, {"type", "feature"}, {"parameters", {{"features", 900}}}}}}};
    write_text(folder / "small.json", scenario.dump());
    for (const char* format : {"euroc", "png"}) {
      const Outcome exported = overfly_program({"export",
                                                (folder / "small.json").string(),
                                                "--format",
                                                format,
                                                "--out",
                                                (folder / format).string(),
                                                "--quiet"});
      ASSERT_EQ(exported.exit_code, 0) << exported.err;
    }
  }
  static void TearDownTestSuite() {
    delete data_;
    data_ = nullptr;
  }

  static std::string data(const std::string& name) { return (data_->path() / name).string(); }
  static std::string truth() { return data("euroc/mav0/state_groundtruth_estimate0/data.csv"); }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  [[nodiscard]] Outcome track(const std::vector<std::string>& more,
                              const std::string& images = "euroc") const {
    std::vector<std::string> arguments{
        "track", "--images", data(images), "--out", path("t.tum"), "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return overfly_program(arguments);
  }

  TemporaryFolder folder_;
  static TemporaryFolder* data_;
};

TemporaryFolder* TrackCommand::data_ = nullptr;

TEST_F(TrackCommand, ScoresAPerfectEstimateAgainstTheTruthOfAnEurocDataSet) {
  const Outcome outcome =
      track({"--estimator", "perfect", "--parameter", "scale=1", "--truth", truth(), "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json report = Json::parse(outcome.out);
  EXPECT_EQ(report.at("dataset").at("layout"), "euroc");
  EXPECT_EQ(report.at("states").at("TRACKING"), 21);
  const Json& score = report.at("score");
  EXPECT_EQ(score.at("outcome"), "COMPLETED");
  for (const char* mode : {"origin", "se3", "sim3", "yaw_only"}) {
    // The truth stands in the file at the IMU's samples: between them it is interpolated.
    EXPECT_LT(score.at("alignments").at(mode).at("position_rmse_m").get<double>(), 0.01) << mode;
  }
  const auto written = read_trajectory(path("t.tum"));
  ASSERT_TRUE(written.ok()) << written.error().message;
  EXPECT_EQ(written->trajectory.size(), 21U);
  const Outcome people = track({"--estimator", "perfect", "--truth", truth()});
  EXPECT_THAT(people.out, HasSubstr("data set: euroc, 21 images of 160 x 120 px\n"));
  EXPECT_THAT(people.out, HasSubstr("outcome: COMPLETED, coverage 100.0 %\n"));
  EXPECT_THAT(people.out, HasSubstr("sim3"));
  EXPECT_THAT(people.out, HasSubstr("note: the truth gives poses of the body"));
}

TEST_F(TrackCommand, TakesAScenariosEstimatorWithItsParametersAndOthers) {
  const std::string scenario = data("small.json");
  const auto features = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = more;
    arguments.insert(arguments.end(), {"--json", "--statuses", path("s.jsonl")});
    const Outcome outcome = track(arguments, "png");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    if (outcome.exit_code != 0) return std::string();
    return Json::parse(outcome.out)
        .at("estimator")
        .at("parameters")
        .at("features")
        .get<std::string>();
  };
  EXPECT_EQ(features({"--scenario-estimator", scenario + ":many"}), "900");
  EXPECT_EQ(features({"--scenario-estimator", scenario + ":few"}), "300");
  EXPECT_EQ(features({"--scenario-estimator", scenario + ":few", "--parameter", "features=400"}),
            "400");
  EXPECT_EQ(features({"--set", "parameters.features=500"}), "500");
  EXPECT_TRUE(fs::exists(path("s.jsonl")));
  const Outcome which = track({"--scenario-estimator", scenario});
  EXPECT_EQ(which.exit_code, 2);
  EXPECT_THAT(which.err, HasSubstr("must be FILE:NAME with a NAME of few, many"));
}

TEST_F(TrackCommand, TakesAPlainFolderWithTimesAndACamera) {
  std::string times;
  for (int i = 0; i < 21; ++i) times += std::to_string(0.1 * i) + "\n";
  write_text(path("times.txt"), times);
  const Outcome outcome = track({"--times",
                                 path("times.txt"),
                                 "--camera",
                                 "80,80,79.5,59.5",
                                 "--distortion",
                                 "radtan:-0.01,0.001,0,0",
                                 "--json"},
                                "png/images/camera0");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json camera = Json::parse(outcome.out).at("dataset").at("camera");
  EXPECT_EQ(camera.at("width_px"), 160);
  EXPECT_EQ(camera.at("distortion").at("model"), "radtan");
}

TEST_F(TrackCommand, NamesWhatIsWrong) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--camera", "80,80,79.5"}, "--camera 80,80,79.5: must be FX,FY,CX,CY"},
      {{"--camera", "80,80,79.5,nan"}, "--camera 80,80,79.5,nan: must be FX,FY,CX,CY"},
      {{"--camera", "80,80,79.5,59.5,0,120"}, "must be of a WIDTH and HEIGHT in [1, 65536]"},
      {{"--camera", "-80,80,79.5,59.5"}, "camera: "},
      {{"--camera", "80,80,79.5,59.5,640,480"}, "160 x 120 px: must be 640 x 480 px"},
      {{"--distortion", "fov:0.9"}, "must be given together with --camera"},
      {{"--camera", "80,80,79.5,59.5", "--distortion", "fov:a"}, "--distortion fov:a: must be"},
      {{"--camera", "80,80,79.5,59.5", "--distortion", "radtan"}, "--distortion radtan: must be"},
      {{"--parameter", "features=-1"}, "features"},
      {{"--parameter", "corners=7"}, "corners"},
      {{"--parameter", "features"}, "--parameter"},
      {{"--set", "lcm.url=memq://"}, "lcm"},
      {{"--estimator", "process"}, "command: must be given if type is process"},
      {{"--command", "'/bin/true"}, "must be without an open '"},
      {{"--command", "/no/such/program"}, "/no/such/program"},
      {{"--estimator", "perfect"}, "needs --truth with times"},
      {{"--estimator", "orb"}, "--estimator"},
      {{"--layout", "tum-mono"}, "images: no such folder"},
      {{"--camera-name", "cam7"}, "cam7/data.csv: no such file"},
      {{"--points", "/no/such/folder/p.ply"}, "folder /no/such/folder does not exist"},
      {{"--points", "/"}, "/: is a folder, must be a file"},
      {{"--statuses", path("t.tum")}, "is the file of --statuses"},
  };
  for (const auto& [arguments, message] : cases) {
    const Outcome outcome = track(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments.front() << " " << arguments.back() << "\n"
                                    << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(message));
    EXPECT_FALSE(fs::exists(path("t.tum")));
  }
}

TEST_F(TrackCommand, ChecksThatItsOutputsCanBeWritten) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write to every folder";
  const fs::path locked = folder_.path() / "locked";
  fs::create_directories(locked);
  fs::permissions(locked, fs::perms::owner_read | fs::perms::owner_exec);
  for (const char* option : {"--points", "--statuses", "--debug", "--estimator-folder"}) {
    const bool is_folder = std::string(option) == "--debug" || option[2] == 'e';
    const std::string target = is_folder ? locked.string() : (locked / "out").string();
    const Outcome outcome = track({option, target});
    EXPECT_EQ(outcome.exit_code, 1) << option;
    EXPECT_THAT(outcome.err,
                HasSubstr(target + ": folder " + locked.string() + " cannot be written to: "));
    EXPECT_FALSE(fs::exists(path("t.tum"))) << option;
  }
  fs::permissions(locked, fs::perms::owner_all);
}

/// A process that fails over its calibration, or exits at frame 7.
std::vector<std::string> failing_estimator(const fs::path& folder, const std::string& how) {
  const fs::path file = folder / "failing.py";
  write_text(file,
             "import os, sys\n"
             "sys.path.insert(0, sys.argv[1])\n"
             "import overfly_vo\n"
             "class Failing(overfly_vo.Estimator):\n"
             "    def calibrate(self, camera):\n"
             "        if sys.argv[2] == 'calibration':\n"
             "            raise RuntimeError('no vocabulary at /nowhere')\n"
             "    def track(self, frame):\n"
             "        if frame.index == 2:\n"
             "            print('nothing to worry about', flush=True)\n"
             "            print('warning: few corners', flush=True)\n"
             "        if frame.index == 7:\n"
             "            os._exit(3)\n"
             "        return overfly_vo.Answer(state=overfly_vo.TRACKING,\n"
             "                                 position=(1.0 * frame.index, 0.0, 0.0))\n"
             "overfly_vo.run(Failing())\n");
  return {"python3", "-B", file.string(), source_file("vo_bridges/client").string(), how};
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

TEST_F(TrackCommand, FailsWhenTheEstimatorNeverRan) {
  const Outcome never =
      track({"--command", joined(failing_estimator(folder_.path(), "calibration"))});
  EXPECT_EQ(never.exit_code, 1);
  EXPECT_THAT(never.err, HasSubstr("error: the estimator never ran: "));
  EXPECT_THAT(never.err, HasSubstr("no vocabulary at /nowhere"));
}

TEST_F(TrackCommand, CountsTheFramesOfTheDataSetAfterACrash) {
  const Outcome crashed =
      track({"--command", joined(failing_estimator(folder_.path(), "flight")), "--truth", truth()});
  EXPECT_EQ(crashed.exit_code, 0) << crashed.err;
  EXPECT_THAT(crashed.out, HasSubstr("LOST 1 of 8 frames, 13 not sent"));
  EXPECT_THAT(crashed.out, HasSubstr("outcome: CRASHED, coverage 33.3 %\n"));
  // The estimator's warnings are shown even with --quiet, what else it says is not.
  EXPECT_THAT(crashed.err, HasSubstr("estimator: warning: few corners\n"));
  EXPECT_THAT(crashed.err, Not(HasSubstr("nothing to worry about")));
}

TEST_F(TrackCommand, RunFailsWhenNoneOfItsEstimatorsRan) {
  const Json gone = {{"name", "gone"},
                     {"type", "process"},
                     {"command", failing_estimator(folder_.path(), "calibration")}};
  const Json perfect = {{"name", "perfect"}, {"type", "perfect"}};
  const auto flown = [&](const Json& estimators, const std::string& name) {
    return overfly_program({"run",
                            data("small.json"),
                            "--out",
                            path(name),
                            "--quiet",
                            "--set",
                            "estimators=" + estimators.dump()});
  };
  const Outcome only_one = flown(Json::array({gone}), "only_one");
  EXPECT_EQ(only_one.exit_code, 1);
  EXPECT_THAT(only_one.err, HasSubstr("error: estimator gone never ran: "));
  EXPECT_THAT(only_one.err, HasSubstr("no vocabulary at /nowhere"));
  const Outcome with_other = flown(Json::array({gone, perfect}), "with_other");
  EXPECT_EQ(with_other.exit_code, 0);
  EXPECT_THAT(with_other.err, HasSubstr("estimator gone never ran"));
  const Json ends = {{"name", "ends"},
                     {"type", "process"},
                     {"command", failing_estimator(folder_.path(), "flight")}};
  const Outcome crashed = flown(Json::array({ends}), "crashed");
  EXPECT_EQ(crashed.exit_code, 0);
  EXPECT_THAT(crashed.out, HasSubstr("CRASHED at "));
  EXPECT_THAT(crashed.out, HasSubstr("    crashed: "));
}

TEST_F(TrackCommand, InterruptKeepsWhatWasTracked) {
  // Long enough not to be over before the signal comes: one image, many times.
  std::string times;
  const std::string image = data("png/images/camera0/000000.png");
  fs::create_directories(path("many"));
  for (int i = 0; i < 3000; ++i) {
    times += std::to_string(i) + " " + std::to_string(i) + ".png\n";
    fs::create_symlink(image, path("many/" + std::to_string(i) + ".png"));
  }
  write_text(path("times.txt"), times);
  RunningProgram program({"track",
                          "--images",
                          path("many"),
                          "--times",
                          path("times.txt"),
                          "--camera",
                          "80,80,79.5,59.5",
                          "--debug",
                          path("debug"),
                          "--out",
                          path("t.tum"),
                          "--statuses",
                          path("s.jsonl")},
                         folder_.path());
  for (int i = 0; i < 3000 && program.running() && !fs::exists(path("debug/000002.jpg")); ++i) {
    poll(nullptr, 0, 10);
  }
  program.signal(SIGINT);
  EXPECT_EQ(program.wait(), 3) << program.err();
  EXPECT_THAT(program.err(), HasSubstr("cancelled after frame"));
  EXPECT_TRUE(fs::exists(path("t.tum")));
  EXPECT_THAT(read_text(path("s.jsonl")), HasSubstr("\"state\":\"INITIALISING\""));
}

}  // namespace
}  // namespace overfly::testing
