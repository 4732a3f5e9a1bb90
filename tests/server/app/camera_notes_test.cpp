// What overfly run says about imagery that its cameras lack.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/app/command_line_fixture.hpp"
#include "tests/server/app/program.hpp"

namespace overfly::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(CommandLine, RunWarnsOfAFlightWithoutImagery) {
  const auto flown_from = [&](const std::string& east_m, const std::string& name) {
    const Outcome flown =
        overfly_program({"run",
                         scenario_file(),
                         "--out",
                         path(name),
                         "--quiet",
                         "--set",
                         "renderer.camera=\"raycast\"",
                         "--set",
                         R"(flight.course.start={"east_m": )" + east_m + R"(, "north_m": 0})"});
    EXPECT_EQ(flown.exit_code, 0) << flown.err;
    return flown.out;
  };
  const std::string warning =
      "warning: no imagery: in 100 % of the frames more than half of the image of the camera is "
      "without imagery\n";
  EXPECT_THAT(flown_from("5000", "away"), HasSubstr(warning));
  EXPECT_THAT(flown_from("0", "above"), Not(HasSubstr("no imagery")));
}

}  // namespace
}  // namespace overfly::testing
