// overfly explain: where the explanation is written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/server/app/command_line_fixture.hpp"
#include "tests/server/app/program.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;

/// The program works in a folder of its own, as the explanations do by default.
class ExplainCommand : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    fs::current_path(path(""));
  }
  void TearDown() override { fs::current_path(before_); }
  /// Flies estimators that are lost; a flight again ends before its first frame.
  static void fly(const std::string& run, const std::string& estimators) {
    const Outcome flown = overfly_program({"run",
                                           scenario_file(),
                                           "--out",
                                           path(run),
                                           "--renderer",
                                           "raycast",
                                           "--set",
                                           "estimators=[" + estimators + "]"});
    ASSERT_TRUE(fs::exists(path(run) + "/metrics.json")) << flown.err;
  }

 private:
  fs::path before_ = fs::current_path();
};

constexpr const char* kLost = R"({"name": "a", "type": "process", "command": ["/bin/false"]})";
constexpr const char* kLostToo = R"({"name": "b", "type": "process", "command": ["/bin/false"]})";

TEST_F(ExplainCommand, EachEstimatorOfARunHasItsFolder) {
  fly("both", std::string(kLost) + "," + kLostToo);
  (void)overfly_program({"explain", path("both"), "--estimator", "b", "--quiet"});
  EXPECT_TRUE(fs::exists(path("explained/both_b")));
  (void)overfly_program({"explain", path("both"), "--quiet"});
  EXPECT_TRUE(fs::exists(path("explained/both_a"))) << "the first one that failed";
  EXPECT_FALSE(fs::exists(path("explained/both")));
}

TEST_F(ExplainCommand, TheOnlyEstimatorOfARunNeedsNoNameInTheFolder) {
  fly("one", kLost);
  const Outcome explained = overfly_program({"explain", path("one"), "--quiet"});
  EXPECT_TRUE(fs::exists(path("explained/one"))) << explained.err;
  EXPECT_THAT(explained.err, ::testing::HasSubstr("estimator a never ran"));
}

}  // namespace
}  // namespace overfly::testing
