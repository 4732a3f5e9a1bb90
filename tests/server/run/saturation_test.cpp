// Overexposed images are reported in the log of a run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::small_scenario;

/// log.jsonl of a run with this sensor, drawn by the ray-caster.
std::string log_with(const std::string& sensor) {
  const TemporaryFolder folder;
  const Scenario scenario =
      small_scenario({"renderer.camera=raycast", "duration_s=1", "camera.sensor=" + sensor});
  RunOptions options;
  options.folder = folder.path() / "run";
  const auto run = run_scenario(scenario, options);
  EXPECT_TRUE(run.ok()) << run.error().message;
  return overfly::testing::read_text(folder.path() / "run" / "log.jsonl");
}

TEST(Saturation, OverexposedImagesAreReportedOnceAndCounted) {
  const std::string log =
      log_with(R"({"full_well_e":10200,"electrons_per_s":5e6,"exposure_ms":50})");
  EXPECT_THAT(log, HasSubstr("of the pixels of frame 0 are saturated (exposure 50 ms)"));
  EXPECT_THAT(log, Not(HasSubstr("of the pixels of frame 1 are saturated")));
  EXPECT_THAT(log, HasSubstr("11 of 11 images are overexposed"));
}

TEST(Saturation, WellExposedImagesAreNotReported) {
  EXPECT_THAT(log_with(R"({"full_well_e":10200,"electrons_per_s":1e5,"exposure_ms":50})"),
              Not(HasSubstr("saturated")));
}

}  // namespace
}  // namespace overfly::server
