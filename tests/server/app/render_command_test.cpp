// overfly render: the image and its depths against what the position says, and the same image as
// other commands give.
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/camera/image.hpp"
#include "core/motion/pose.hpp"
#include "terrain/raster/image_file.hpp"
#include "tests/server/app/command_line_fixture.hpp"
#include "tests/server/app/program.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

class RenderCommand : public CommandLine {
 protected:
  static void SetUpTestSuite() {
    CommandLine::SetUpTestSuite();
    const Outcome made = overfly_program({"world",
                                          "synthesize",
                                          "--out",
                                          path("flat"),
                                          "--size-m",
                                          "600",
                                          "--texel-m",
                                          "2",
                                          "--relief-m",
                                          "0",
                                          "--center-lat",
                                          "46.5",
                                          "--center-lon",
                                          "7.25",
                                          "--quiet"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }

  /// Renders over the middle of the flat world by casting rays, which needs no EGL.
  static Outcome over_flat_ground(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render",
                                       "--world",
                                       path("flat"),
                                       "--lat",
                                       "46.5",
                                       "--lon",
                                       "7.25",
                                       "--renderer",
                                       "raycast"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return overfly_program(arguments);
  }

  static DepthImage depths(const std::string& file) {
    GDALAllRegister();
    const std::unique_ptr<GDALDataset> dataset(
        GDALDataset::FromHandle(GDALOpen(file.c_str(), GA_ReadOnly)));
    if (!dataset) throw std::runtime_error(file + ": not a raster");
    DepthImage depth(dataset->GetRasterXSize(), dataset->GetRasterYSize(), 1);
    const CPLErr outcome = dataset->GetRasterBand(1)->RasterIO(GF_Read,
                                                               0,
                                                               0,
                                                               depth.width_px,
                                                               depth.height_px,
                                                               depth.data.data(),
                                                               depth.width_px,
                                                               depth.height_px,
                                                               GDT_Float32,
                                                               0,
                                                               0);
    if (outcome != CE_None) throw std::runtime_error(file + ": cannot be read");
    return depth;
  }

  static Image png(const std::string& file) {
    auto image = terrain::read_png(file, 4096);
    if (!image) throw std::runtime_error(image.error().message);
    return std::move(*image);
  }
};

TEST_F(RenderCommand, DepthsAreThoseOfFlatGround) {
  // Depth is along the optical axis: constant below a level nadir camera, whatever the pixel.
  ASSERT_EQ(over_flat_ground({"--height-agl",
                              "100",
                              "--width",
                              "161",
                              "--height",
                              "121",
                              "--out",
                              path("level.png"),
                              "--depth",
                              path("level.tif")})
                .exit_code,
            0);
  const DepthImage level = depths(path("level.tif"));
  ASSERT_EQ(level.width_px, 161);
  ASSERT_EQ(level.height_px, 121);
  for (const float depth_m : level.data) ASSERT_NEAR(depth_m, 100.0, 0.005);

  // Rolled by 30 deg: the middle of the image sees the ground at height / cos 30.
  ASSERT_EQ(over_flat_ground({"--height-agl",
                              "100",
                              "--roll",
                              "30",
                              "--width",
                              "161",
                              "--height",
                              "121",
                              "--out",
                              path("rolled.png"),
                              "--depth",
                              path("rolled.tif")})
                .exit_code,
            0);
  const DepthImage rolled = depths(path("rolled.tif"));
  EXPECT_NEAR(rolled.at(80, 60), 100.0 / std::cos(rad_from_deg(30.0)), 0.02);
  // Right wing down: the axis points to the left of the ground below. The camera's x axis is right,
  // so the ground is farther on its left.
  EXPECT_GT(rolled.at(20, 60), rolled.at(140, 60));
}

TEST_F(RenderCommand, ImageHasTheSizeTheColoursAndTheFieldOfViewAsked) {
  const Outcome colour = over_flat_ground(
      {"--height-agl", "120", "--width", "64", "--height", "48", "--out", path("c.png")});
  ASSERT_EQ(colour.exit_code, 0) << colour.err;
  EXPECT_THAT(colour.out, HasSubstr("c.png: 64 x 48 px, texels per pixel "));
  EXPECT_THAT(colour.out, HasSubstr(" 0 % without imagery"));
  const Image rgb = png(path("c.png"));
  EXPECT_EQ(rgb.width_px, 64);
  EXPECT_EQ(rgb.height_px, 48);
  EXPECT_EQ(rgb.channels, 3);
  ASSERT_EQ(over_flat_ground({"--height-agl",
                              "120",
                              "--width",
                              "64",
                              "--height",
                              "48",
                              "--grey",
                              "--out",
                              path("g.png")})
                .exit_code,
            0);
  const Image grey = png(path("g.png"));
  EXPECT_EQ(grey.channels, 1);

  // Twice the tangent of half the field of view from half the height shows the same ground.
  const double narrow_rad = rad_from_deg(40.0);
  const double wide_deg = deg_from_rad(2.0 * std::atan(2.0 * std::tan(0.5 * narrow_rad)));
  ASSERT_EQ(over_flat_ground({"--height-agl",
                              "200",
                              "--fov",
                              "40",
                              "--width",
                              "64",
                              "--height",
                              "48",
                              "--grey",
                              "--out",
                              path("narrow.png")})
                .exit_code,
            0);
  ASSERT_EQ(over_flat_ground({"--height-agl",
                              "100",
                              "--fov",
                              std::to_string(wide_deg),
                              "--width",
                              "64",
                              "--height",
                              "48",
                              "--grey",
                              "--out",
                              path("wide.png")})
                .exit_code,
            0);
  const Image narrow = png(path("narrow.png"));
  const Image wide = png(path("wide.png"));
  double most = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < narrow.data.size(); ++i) {
    const double difference = std::abs(double(narrow.data[i]) - double(wide.data[i]));
    most = std::max(most, difference);
    sum += difference;
  }
  EXPECT_LE(most, 3.0);
  EXPECT_LT(sum / static_cast<double>(narrow.data.size()), 0.5);
}

TEST_F(RenderCommand, YawTurnsTheImage) {
  for (const char* yaw : {"0", "180"}) {
    ASSERT_EQ(over_flat_ground({"--height-agl",
                                "100",
                                "--yaw",
                                yaw,
                                "--width",
                                "64",
                                "--height",
                                "64",
                                "--grey",
                                "--out",
                                path(std::string("yaw") + yaw + ".png")})
                  .exit_code,
              0);
  }
  const Image north = png(path("yaw0.png"));
  Image turned = png(path("yaw180.png"));
  std::reverse(turned.data.begin(), turned.data.end());
  double sum = 0.0;
  for (std::size_t i = 0; i < north.data.size(); ++i) {
    sum += std::abs(double(north.data[i]) - double(turned.data[i]));
  }
  EXPECT_LT(sum / static_cast<double>(north.data.size()), 0.5);
}

TEST_F(RenderCommand, GivesTheFramesOfAScenarioAsTheyAreExported) {
  SKIP_WITHOUT_EGL();
  const std::vector<std::string> sets = {
      "--set", "camera.sensor.exposure_ms=5", "--set", "camera.sensor.read_noise_e=10"};
  std::vector<std::string> arguments{
      "export", scenario_file(), "--format", "png", "--out", path("frames"), "--quiet"};
  arguments.insert(arguments.end(), sets.begin(), sets.end());
  const Outcome exported = overfly_program(arguments);
  ASSERT_EQ(exported.exit_code, 0) << exported.err;
  std::vector<fs::path> images;
  for (const auto& entry : fs::recursive_directory_iterator(path("frames"))) {
    if (entry.path().extension() == ".png") images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  ASSERT_EQ(images.size(), 11U);
  for (const std::size_t frame : {0U, 7U}) {
    arguments = {"render",
                 "--scenario",
                 scenario_file(),
                 "--frame",
                 std::to_string(frame),
                 "--out",
                 path("frame.png")};
    arguments.insert(arguments.end(), sets.begin(), sets.end());
    const Outcome drawn = overfly_program(arguments);
    ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
    EXPECT_THAT(drawn.out, HasSubstr(", exposure 5 ms, gain 1, "));
    EXPECT_EQ(png(path("frame.png")).data, png(images[frame]).data) << frame;
  }
}

TEST_F(RenderCommand, TakesAScenariosCameraToAPlace) {
  SKIP_WITHOUT_EGL();
  const Outcome drawn = overfly_program({"render",
                                         "--scenario",
                                         scenario_file(),
                                         "--set",
                                         "world.manifest=" + path("flat/world.json"),
                                         "--lat",
                                         "46.5",
                                         "--lon",
                                         "7.25",
                                         "--height-agl",
                                         "80",
                                         "--out",
                                         path("place.png"),
                                         "--depth",
                                         path("place.tif")});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  const DepthImage depth = depths(path("place.tif"));
  EXPECT_EQ(depth.width_px, 160);
  EXPECT_NEAR(depth.at(80, 60), 80.0, 0.01);
}

TEST_F(RenderCommand, NamesWhatIsWrong) {
  const auto refused = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"render", "--out", path("none.png")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = overfly_program(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_FALSE(fs::exists(path("none.png")));
    return outcome.err;
  };
  EXPECT_THAT(refused({}), HasSubstr("one of --world and --scenario must be given"));
  EXPECT_THAT(refused({"--world", path("flat"), "--scenario", scenario_file()}),
              HasSubstr("one of --world and --scenario must be given"));
  EXPECT_THAT(refused({"--world", path("flat"), "--lat", "46.5"}),
              HasSubstr("--lat, --lon and --height-agl: must be given together"));
  EXPECT_THAT(refused({"--world", path("flat")}),
              HasSubstr("--lat, --lon and --height-agl: must be given with --world"));
  EXPECT_THAT(refused({"--scenario", scenario_file(), "--camera", "left"}), HasSubstr("left"));
  EXPECT_THAT(refused({"--scenario", path("no.json")}), HasSubstr("no.json"));
  const std::vector<std::string> place = {
      "--world", path("flat"), "--lat", "46.5", "--lon", "7.25", "--height-agl", "100"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), place.begin(), place.end());
    return more;
  };
  EXPECT_THAT(refused(with({"--width", "9000"})), HasSubstr("--width"));
  EXPECT_THAT(refused(with({"--fov", "180"})), HasSubstr("180"));
  EXPECT_THAT(refused(with({"--fov", "nan"})), HasSubstr("field of view = nan"));
  EXPECT_THAT(refused(with({"--renderer", "vulkan"})), HasSubstr("vulkan"));
}

TEST_F(RenderCommand, NamesAFrameBeyondTheFlightAndAFileThatCannotBeWritten) {
  SKIP_WITHOUT_EGL();
  const Outcome late = overfly_program(
      {"render", "--scenario", scenario_file(), "--frame", "11", "--out", path("late.png")});
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_THAT(late.err, HasSubstr("--frame 11: the flight has 11 frames"));
  const Outcome nowhere = over_flat_ground(
      {"--height-agl", "100", "--width", "32", "--height", "32", "--out", path("no/where.png")});
  EXPECT_EQ(nowhere.exit_code, 1);
  EXPECT_THAT(nowhere.err, HasSubstr("no/where.png: cannot be written"));
}

TEST_F(RenderCommand, WritesItsFilesOverNoOther) {
  const Outcome twice = over_flat_ground(
      {"--height-agl", "100", "--out", path("same.tif"), "--depth", path("same.tif")});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("must be another"));
  EXPECT_FALSE(fs::exists(path("same.tif")));
  const std::string before = read_text(scenario_file());
  const Outcome scenario =
      overfly_program({"render", "--scenario", scenario_file(), "--out", scenario_file()});
  EXPECT_EQ(scenario.exit_code, 2);
  EXPECT_EQ(read_text(scenario_file()), before);
}

}  // namespace
}  // namespace overfly::testing
