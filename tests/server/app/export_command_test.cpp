// `overfly export` and `overfly doctor --camera` through the real program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/server/app/program.hpp"
#include "tests/support/support.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

class ExportCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    const Outcome made = overfly_program(
        {"world", "synthesize", "--out", path("world"), "--size-m", "600", "--texel-m", "2"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const Json scenario = {{"format_version", 1},
                           {"world", {{"manifest", path("world/world.json")}}},
                           {"flight", {{"course", {{"length_m", 800}, {"leg_length_m", 300}}}}},
                           {"duration_s", 1},
                           {"camera", {{"width_px", 160}, {"height_px", 120}, {"rate_hz", 10}}},
                           {"renderer", {{"camera", "raycast"}}}};
    write_text(scenario_file(), scenario.dump());
  }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  [[nodiscard]] std::string scenario_file() const { return path("small.json"); }
  [[nodiscard]] Outcome exported(const std::string& source,
                                 const std::string& format,
                                 const std::string& out,
                                 const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{
        "export", source, "--format", format, "--out", path(out), "--threads", "1", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return overfly_program(arguments);
  }

  TemporaryFolder folder_;
};

TEST_F(ExportCommand, WritesEveryFormatOfAScenarioAndOfItsRun) {
  const Outcome run = overfly_program({"run", scenario_file(), "--out", path("run")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Outcome mono =
      exported(path("run"), "tum-mono", "mono", {"--truth", "depth,flow", "--video", "camera"});
  ASSERT_EQ(mono.exit_code, 0) << mono.err;
  EXPECT_THAT(mono.out, HasSubstr("11 images of 11 frames, tum-mono"));
  EXPECT_THAT(mono.out, HasSubstr("imagery: "));
  EXPECT_TRUE(fs::exists(path("mono/times.txt")));
  EXPECT_TRUE(fs::exists(path("mono/video.webm")));
  EXPECT_TRUE(fs::exists(path("mono/truth/depth/camera0/00010.tif")));

  ASSERT_EQ(exported(path("run"), "euroc", "euroc", {"--imu-rate", "100"}).exit_code, 0);
  const Outcome scored = overfly_program({"evaluate",
                                          "--truth",
                                          path("mono/groundtruth.txt"),
                                          "--estimate",
                                          path("mono/groundtruth.txt"),
                                          "--alignment",
                                          "none"});
  EXPECT_EQ(scored.exit_code, 0) << scored.err;
  ASSERT_EQ(exported(scenario_file(), "kitti", "kitti").exit_code, 0);
  // Made of the run or of its scenario: the same images.
  EXPECT_EQ(read_text(path("kitti/image_0/000007.png")), read_text(path("mono/images/00007.png")));

  const Outcome part =
      exported(scenario_file(), "png", "part", {"--from", "0.5", "--to", "0.7", "--json"});
  ASSERT_EQ(part.exit_code, 0) << part.err;
  EXPECT_EQ(Json::parse(part.out).at("frames"), 3);
  EXPECT_TRUE(Json::parse(part.out).at("stages").contains("write_images"));
  EXPECT_EQ(
      exported(scenario_file(), "webm", "f.webm", {"--video", "camera", "--to", "0.3"}).exit_code,
      0);
  EXPECT_TRUE(fs::exists(path("f.webm")));
}

TEST_F(ExportCommand, NamesWhatIsWrong) {
  const Outcome format = exported(scenario_file(), "kiti", "d");
  EXPECT_EQ(format.exit_code, 2);
  EXPECT_THAT(format.err, HasSubstr("format = kiti: must be one of tum-mono, euroc, kitti, png"));
  const Outcome truth = exported(scenario_file(), "png", "d", {"--truth", "depth,colour"});
  EXPECT_EQ(truth.exit_code, 2);
  EXPECT_THAT(truth.err, HasSubstr("truth = colour"));
  EXPECT_EQ(exported(path("none.json"), "png", "d").exit_code, 2);
  const Outcome full = exported(scenario_file(), "png", "world");
  EXPECT_EQ(full.exit_code, 2);
  EXPECT_THAT(full.err, HasSubstr("not empty"));
  EXPECT_TRUE(fs::exists(path("world/world.json")));
}

TEST_F(ExportCommand, InterruptLeavesAWholeShorterDataSet) {
  RunningProgram program({"export",
                          scenario_file(),
                          "--format",
                          "png",
                          "--out",
                          path("d"),
                          "--set",
                          "camera.rate_hz=1000"},
                         folder_.path());
  // The first image is there: frames are being made.
  for (int i = 0; i < 3000 && program.running() && !fs::exists(path("d/images/camera0/000000.png"));
       ++i) {
    poll(nullptr, 0, 10);
  }
  program.signal(SIGINT);
  EXPECT_EQ(program.wait(), 3) << program.err();
  const Json about = Json::parse(read_text(path("d/overfly.json")));
  EXPECT_EQ(about.at("complete"), false);
  EXPECT_GE(about.at("frames").get<int>(), 1);
  EXPECT_TRUE(fs::exists(path("d/camera0.csv")));
}

TEST_F(ExportCommand, DoctorMeasuresAScenariosCameras) {
  Json scenario = Json::parse(read_text(scenario_file()));
  scenario["camera"] = {{"width_px", 400}, {"height_px", 300}};
  write_text(scenario_file(), scenario.dump());
  const std::vector<std::string> test{
      "doctor", "--camera", "--scenario", scenario_file(), "--pairs", "2", "--json"};
  // Coarse imagery: the limit is not what is tested here.
  std::vector<std::string> wide = test;
  wide.insert(wide.end(), {"--limit-px", "1"});
  const Outcome well = overfly_program(wide);
  ASSERT_EQ(well.exit_code, 0) << well.err << well.out;
  const Json findings = Json::parse(well.out);
  EXPECT_EQ(findings.at("passed"), true);
  EXPECT_EQ(findings.at("cameras").at(0).at("pairs").size(), 2U);

  std::vector<std::string> narrow = test;
  narrow.insert(narrow.end(), {"--limit-px", "0.000001"});
  const Outcome ill = overfly_program(narrow);
  EXPECT_EQ(ill.exit_code, 4);
  EXPECT_THAT(Json::parse(ill.out).at("cameras").at(0).at("fault"), HasSubstr("median residual"));
  EXPECT_EQ(overfly_program({"doctor", "--pairs", "2"}).exit_code, 2) << "needs --camera";
}

}  // namespace
}  // namespace overfly::testing
