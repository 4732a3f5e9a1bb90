// overfly world: what the synthesized worlds are, where they lie, and how they are described.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/server/app/program.hpp"
#include "tests/support/support.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class WorldCommand : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_.path() / name).string();
  }

  /// A small landscape. @return the content of its files by name
  std::map<std::string, std::string> landscape(const std::string& name,
                                               const std::vector<std::string>& options) {
    std::vector<std::string> arguments{
        "world", "synthesize", "--out", path(name), "--size-m", "500", "--texel-m", "4", "--quiet"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome made = overfly_program(arguments);
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(made.out, path(name) + "/world.json\n");
    EXPECT_EQ(made.err, "") << "--quiet";
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(path(name))) {
      if (entry.is_regular_file()) {
        files[entry.path().filename().string()] = read_text(entry.path());
      }
    }
    return files;
  }

  [[nodiscard]] std::string info(const std::string& world) const {
    const Outcome outcome = overfly_program({"world", "info", world});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.out;
  }

  [[nodiscard]] std::string refused(const std::vector<std::string>& arguments,
                                    int exit_code = 2) const {
    std::vector<std::string> all{"world"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome outcome = overfly_program(all);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.out << outcome.err;
    return outcome.err;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(WorldCommand, ALandscapeFollowsFromItsSeed) {
  const auto first = landscape("a", {"--seed", "5"});
  EXPECT_GE(first.size(), 3U);  // manifest, imagery, elevation
  EXPECT_EQ(landscape("b", {"--seed", "5"}), first);
  EXPECT_NE(landscape("c", {"--seed", "6"}), first);
}

TEST_F(WorldCommand, ALandscapeLiesWhereItIsAskedFor) {
  landscape("alps", {"--center-lat", "46.5", "--center-lon", "7.25", "--relief-m", "0"});
  const std::string text = info(path("alps"));
  // 500 m are 0.0045 deg of latitude and 0.0065 deg of longitude: bounds agree to two decimals.
  EXPECT_THAT(text, HasSubstr("46.49"));
  EXPECT_THAT(text, HasSubstr("46.50"));
  EXPECT_THAT(text, HasSubstr("7.24"));
  EXPECT_THAT(text, HasSubstr("7.25"));
  EXPECT_EQ(info(path("alps/world.json")), text) << "a folder stands for its manifest";
  landscape("south", {"--center-lat", "-33.9", "--center-lon", "151.2"});
  EXPECT_THAT(info(path("south")), HasSubstr("-33.9"));
}

TEST_F(WorldCommand, AStripIsLongAndNarrow) {
  const Outcome made = overfly_program({"world",
                                        "synthesize-strip",
                                        "--out",
                                        path("strip"),
                                        "--length-m",
                                        "3000",
                                        "--width-m",
                                        "1000",
                                        "--texel-m",
                                        "1",
                                        "--post-m",
                                        "30",
                                        "--quiet"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(made.out, path("strip") + "/world.json\n");
  // Rounded up to whole blocks of 1024 texels.
  EXPECT_THAT(info(path("strip")), HasSubstr("extent: 3072 x 1024 m\n"));
}

TEST_F(WorldCommand, NamesWhatCannotBeSynthesized) {
  const auto with = [&](const std::string& option, const std::string& value) {
    return refused({"synthesize", "--out", path("w"), option, value});
  };
  EXPECT_THAT(with("--size-m", "nan"), HasSubstr("size_m"));
  EXPECT_THAT(with("--texel-m", "0"), HasSubstr("texel_m"));
  EXPECT_THAT(with("--texel-m", "-1"), HasSubstr("texel_m"));
  EXPECT_THAT(with("--relief-m", "1e9"), HasSubstr("relief_m"));
  EXPECT_THAT(with("--center-lat", "91"), HasSubstr("lat"));
  EXPECT_THAT(with("--seed", "many"), HasSubstr("--seed"));
  EXPECT_FALSE(fs::exists(path("w/world.json")));
  EXPECT_THAT(refused({"synthesize-strip", "--out", path("w"), "--length-m", "1e12"}),
              HasSubstr("length_m"));
  write_text(path("file"), "");
  EXPECT_THAT(refused({"synthesize", "--out", path("file/world"), "--size-m", "500", "--quiet"}, 1),
              HasSubstr(path("file") + ": cannot be written to"));
}

TEST_F(WorldCommand, DownloadsAreCheckedBeforeAnythingIsAskedFor) {
  const auto with = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"download", "--out", path("w")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return refused(arguments);
  };
  EXPECT_THAT(with({"--size", "1"}), HasSubstr("--center"));
  EXPECT_THAT(with({"--center", "37.9", "--size", "1"}), HasSubstr("--center"));
  EXPECT_THAT(with({"--center", "95,0", "--size", "1"}), HasSubstr("95"));
  EXPECT_THAT(with({"--center", "north,0", "--size", "1"}), HasSubstr("north"));
  EXPECT_THAT(with({"--center", "37.9,-121.8", "--size", "0"}), HasSubstr("size"));
  EXPECT_THAT(with({"--center", "37.9,-121.8", "--size", "1", "--source", "http://a/{z}/{x}/{y}"}),
              HasSubstr("attribution"));
  EXPECT_FALSE(fs::exists(path("w")));
}

}  // namespace
}  // namespace overfly::testing
