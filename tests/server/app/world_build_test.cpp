// `overfly world build` and `info` through the real program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/server/app/program.hpp"
#include "tests/support/support.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class WorldBuildCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    const Outcome made = overfly_program(
        {"world", "synthesize", "--out", path("files"), "--size-m", "600", "--texel-m", "2"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  TemporaryFolder folder_;
};

TEST_F(WorldBuildCommand, MakesAWorldOfFilesAndThenHasNothingToDo) {
  const std::vector<std::string> build = {"world",
                                          "build",
                                          path("files/imagery.tif"),
                                          path("files/elevation.tif"),
                                          "--vertical-datum",
                                          "ellipsoid",
                                          "--attribution",
                                          "Nobody",
                                          "--out",
                                          path("world")};
  const Outcome built = overfly_program(build);
  ASSERT_EQ(built.exit_code, 0) << built.err;
  EXPECT_THAT(built.out, HasSubstr("chunks made, 0 of an earlier build kept"));
  EXPECT_THAT(built.err, HasSubstr("chunks")) << "progress";
  const Outcome info = overfly_program({"world", "info", path("world")});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  for (const char* part : {"name: world",
                           "extent: 640 x 640 m",
                           "bounds: ",
                           "resolution: 2 m per texel",
                           "imagery gaps: 0 %",
                           "used texel for texel",
                           "vertical datum ellipsoid, to the ellipsoid by heights as they are",
                           "cache: in use: ",
                           "attribution: Nobody"}) {
    EXPECT_THAT(info.out, HasSubstr(part));
  }
  const Outcome again = overfly_program(build);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("up to date"));
  const Outcome by_manifest = overfly_program({"world", "build", path("world/world.json")});
  EXPECT_THAT(by_manifest.out, HasSubstr("up to date")) << by_manifest.err;
}

TEST_F(WorldBuildCommand, TakesWhatIsStatedAboutAWorldThatIsThere) {
  const std::vector<std::string> flat = {
      "world", "build", path("files/imagery.tif"), "--out", path("flat"), "--quiet"};
  ASSERT_EQ(overfly_program(flat).exit_code, 0);
  const auto with = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words = flat;
    words.insert(words.end(), options.begin(), options.end());
    return overfly_program(words);
  };
  const Outcome corrected =
      with({"--ground-height-m", "250", "--name", "Field", "--attribution", "Nobody"});
  ASSERT_EQ(corrected.exit_code, 0) << corrected.err;
  const auto written = fs::last_write_time(path("flat/world.json"));
  EXPECT_EQ(with({}).exit_code, 0);
  EXPECT_EQ(with({"--name", "Field"}).exit_code, 0);
  EXPECT_EQ(fs::last_write_time(path("flat/world.json")), written) << "as it was";
  const Outcome info = overfly_program({"world", "info", path("flat")});
  EXPECT_THAT(info.out, HasSubstr("name: Field"));
  EXPECT_THAT(info.out, HasSubstr("250.00 m"));
  EXPECT_THAT(info.out, HasSubstr("attribution: Nobody"));
  const Outcome manifest =
      overfly_program({"world", "build", path("flat/world.json"), "--ground-height-m", "3"});
  EXPECT_EQ(manifest.exit_code, 2);
  EXPECT_THAT(manifest.err, HasSubstr("--ground-height-m: only for imagery and elevation files"));
}

TEST_F(WorldBuildCommand, LeavesNoManifestOfAWorldThatCannotBeBuilt) {
  fs::copy_file(path("files/elevation.tif"), path("cut.tif"));
  fs::resize_file(path("cut.tif"), fs::file_size(path("cut.tif")) / 2);
  const Outcome cut = overfly_program({"world",
                                       "build",
                                       path("files/imagery.tif"),
                                       path("cut.tif"),
                                       "--out",
                                       path("second"),
                                       "--quiet"});
  ASSERT_NE(cut.exit_code, 0);
  EXPECT_FALSE(fs::exists(path("second/world.json")));
  const Outcome whole = overfly_program({"world",
                                         "build",
                                         path("files/imagery.tif"),
                                         path("files/elevation.tif"),
                                         "--out",
                                         path("second"),
                                         "--quiet"});
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
}

TEST_F(WorldBuildCommand, DoesNotTouchAnotherWorldsFolder) {
  const Outcome other = overfly_program(
      {"world", "build", path("files/imagery.tif"), "--out", path("files"), "--quiet"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("exists and lists other layers"));
}

TEST_F(WorldBuildCommand, NamesWhatIsWrong) {
  const Outcome nowhere = overfly_program({"world", "build", path("files/imagery.tif")});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("--out is missing"));
  const Outcome datum = overfly_program({"world",
                                         "build",
                                         path("files/imagery.tif"),
                                         "--vertical-datum",
                                         "msl",
                                         "--out",
                                         path("world")});
  EXPECT_EQ(datum.exit_code, 2);
  EXPECT_THAT(datum.err, HasSubstr("--vertical-datum msl: must be one of ellipsoid"));
  EXPECT_FALSE(fs::exists(path("world")));
  const Outcome gone = overfly_program({"world", "build", path("gone.tif"), "--out", path("w")});
  EXPECT_EQ(gone.exit_code, 2);
  EXPECT_THAT(gone.err, HasSubstr("gone.tif: no such file"));
}

}  // namespace
}  // namespace overfly::testing
