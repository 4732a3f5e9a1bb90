// The other commands: results, errors and exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/server/app/command_line_fixture.hpp"
#include "tests/server/app/program.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

TEST_F(CommandLine, UsageErrorsExitWith2) {
  EXPECT_EQ(overfly_program({}).exit_code, 2);
  EXPECT_EQ(overfly_program({"fly"}).exit_code, 2);
  EXPECT_EQ(overfly_program({"run"}).exit_code, 2);
  EXPECT_EQ(overfly_program({"--help"}).exit_code, 0);
  EXPECT_THAT(overfly_program({"--version"}).out, HasSubstr("overfly 0."));
}

TEST_F(CommandLine, WorldInfoDescribesAWorldAndNamesMissingFiles) {
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

/// A script must not take a cut result for a whole one.
TEST_F(CommandLine, AnOutputThatCannotBeWrittenIsAFailure) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const Outcome outcome = overfly_program({"scenario", "schema"}, "/dev/full");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("the standard output cannot be written"));
}

TEST_F(CommandLine, DoctorFindsAFolderThatCannotBeWritten) {
  const Outcome good = overfly_program({"doctor", "--runs", path("runs")});
  EXPECT_THAT(good.out, HasSubstr("rasters (GDAL)"));
  EXPECT_EQ(good.exit_code, draws() ? 0 : 4) << good.out;
  write_text(path("file"), "");
  const Outcome bad = overfly_program({"doctor", "--runs", path("file")});
  EXPECT_EQ(bad.exit_code, 4);
  EXPECT_THAT(bad.out, HasSubstr("cannot be written to"));
}

TEST_F(CommandLine, BenchReportsTheCostOfBothRenderers) {
  if (!draws()) GTEST_SKIP() << "OpenGL cannot draw here";
  const Outcome done =
      overfly_program({"bench", "--json", "--repetitions", "1", "--flight-s", "1"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const Json drawing = Json::parse(done.out).at("drawing");
  for (const char* ratio : {"camera_per_quad", "raycast_per_quad", "raycast_banked_per_quad"}) {
    ASSERT_TRUE(drawing.contains(ratio)) << ratio;
    EXPECT_GT(drawing.at(ratio).get<double>(), 0.0) << ratio;
  }
  EXPECT_GT(Json::parse(done.out).at("dynamics").at("times_real_time").get<double>(), 1.0);
}

}  // namespace
}  // namespace overfly::testing
