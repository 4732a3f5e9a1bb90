// overfly calibrate: files, output and exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/server/app/program.hpp"
#include "tests/support/support.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

std::string lens_scenario(const TemporaryFolder& folder) {
  const fs::path file = folder.path() / "lens.json";
  write_text(file, R"({"format_version": 1, "world": {"builtin": {}}, "flight": {"course": {}},
    "camera": {"width_px": 480, "height_px": 360, "fx_px": 340, "fy_px": 338.5,
               "distortion": {"model": "radtan", "coefficients": [-0.2, 0.05, 0, 0]}}})");
  return file.string();
}

TEST(CalibrateCommand, CalibratesAScenariosCameraThenItsSavedImages) {
  const TemporaryFolder folder;
  const std::string images = (folder.path() / "images").string();
  const std::string out = (folder.path() / "camera.json").string();
  const Outcome made = overfly_program({"calibrate",
                                        "--scenario",
                                        lens_scenario(folder),
                                        "--board",
                                        "9x6",
                                        "--square-m",
                                        "0.03",
                                        "--views",
                                        "9",
                                        "--save-images",
                                        images,
                                        "--out",
                                        out,
                                        "--export",
                                        "dso=" + (folder.path() / "camera.txt").string(),
                                        "--quiet"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("9 views, 0 images left out; 480 x 360 px, radtan"));
  EXPECT_THAT(made.out, HasSubstr("true     340.000000"));
  EXPECT_THAT(read_text(folder.path() / "camera.txt"), HasSubstr("RadTan "));

  const Outcome read = overfly_program(
      {"calibrate", "--images", images, "--board", "9x6", "--square-m", "0.03", "--json"});
  ASSERT_EQ(read.exit_code, 0) << read.err;
  const Json json = Json::parse(read.out);
  EXPECT_NEAR(json.at("fx_px").get<double>(), 340.0, 1.7);  // nine views of sharp images
  EXPECT_LT(json.at("rms_px").get<double>(), 0.15);
  EXPECT_EQ(json.at("distortion").at("model"), "radtan");
  EXPECT_EQ(json.at("fx_px"), Json::parse(read_text(out)).at("fx_px"));
}

TEST(CalibrateCommand, ExplainsWhatItRefuses) {
  const TemporaryFolder folder;
  const std::string images = folder.path().string();
  const auto refused = [&](std::vector<std::string> arguments, const std::string& text) {
    arguments.insert(arguments.begin(), "calibrate");
    const Outcome outcome = overfly_program(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << text;
    EXPECT_THAT(outcome.err, HasSubstr(text));
  };
  refused({"--images", images, "--board", "9x7", "--square-m", "0.03"}, "half a turn");
  refused({"--images", images, "--board", "9x", "--square-m", "0.03"}, "COLSxROWS");
  refused({"--images", images, "--board", "9x6", "--square-m", "0"}, "square_m = 0");
  refused({"--images", images, "--board", "9x6", "--square-m", "0.03"}, "contains 0 images");
  refused({"--board", "9x6", "--square-m", "0.03"}, "one of --images and --scenario");
  refused({"--images", images, "--board", "9x6", "--square-m", "0.03", "--export", "pdf=a"},
          "FORMAT=FILE");
  const std::string scenario = lens_scenario(folder);
  const std::string text = read_text(scenario);
  refused({"--scenario", scenario, "--board", "9x6", "--square-m", "0.03", "--out", scenario},
          "must be another");
  refused({"--scenario",
           scenario,
           "--board",
           "9x6",
           "--square-m",
           "0.03",
           "--export",
           "dso=" + (folder.path() / "a").string(),
           "--export",
           "svo=" + (folder.path() / "." / "a").string()},
          "must be another");
  EXPECT_EQ(read_text(scenario), text);
  refused({"--images", images, "--board", "9x6", "--square-m", "0.03", "--k3", "--model", "none"},
          "--k3");
}

}  // namespace
}  // namespace overfly::testing
