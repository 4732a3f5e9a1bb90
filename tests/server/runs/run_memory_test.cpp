#include "server/runs/run_memory.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

constexpr std::uint64_t kPixels = 1280 * 960;

/// A flight with the usual camera.
Scenario flight_with(const std::string& estimators) {
  return testing::small_scenario(
      {R"(cameras=[{"name":"a","width_px":1280,"height_px":960}])", "estimators=" + estimators});
}

std::uint64_t bytes_with(const std::string& type) {
  return memory_of(flight_with(R"([{"name":"e","type":")" + type + R"("}])")).images_bytes;
}

TEST(RunMemoryOfEstimators, DependsOnTheirType) {
  const std::uint64_t least = bytes_with("perfect");
  EXPECT_EQ(bytes_with("baseline_hold"), least);
  EXPECT_GT(bytes_with("baseline_homography"), least + 20 * kPixels);
  // 50 keyframes of an old map and 50 of a new one, with smaller levels.
  EXPECT_GT(bytes_with("feature"), least + 133 * kPixels);
}

TEST(RunMemoryOfEstimators, UsualFlightsFitIntoASmallMachine) {
  const Scenario scenario = flight_with(
      R"([{"name":"a","type":"feature"},{"name":"b","type":"feature"},)"
      R"({"name":"c","type":"baseline_homography"},{"name":"d","type":"baseline_hold"},)"
      R"({"name":"e","type":"baseline_dead_reckoning"}])");
  // Four fifths of 2 GiB.
  const MemoryBudget small((std::uint64_t{2} << 30U) / 5 * 4, true);
  const Status fits = small.check(scenario);
  EXPECT_TRUE(fits) << fits.error().message;
}

TEST(MemoryBudget, LeastMachineBytesIsTheSmallestThatHolds) {
  constexpr std::uint64_t kMib = std::uint64_t{1} << 20U;
  for (const RunMemory& memory : {RunMemory{100 * kMib, 900 * kMib},
                                  RunMemory{900 * kMib, 900 * kMib},
                                  RunMemory{7777 * kMib + 1, 1250 * kMib}}) {
    const auto holds = [&](std::uint64_t machine_bytes) {
      const auto limit = static_cast<std::uint64_t>(0.8 * static_cast<double>(machine_bytes));
      return MemoryBudget(limit, false).holds(memory);
    };
    const std::uint64_t least = MemoryBudget::least_machine_bytes(memory);
    EXPECT_TRUE(holds(least)) << memory.images_bytes;
    EXPECT_FALSE(holds(least - 10)) << memory.images_bytes;
  }
}

TEST(RunMemoryOfCameras, CountsWhatOpenGlNeedsForALens) {
  const auto bytes_of = [](const std::string& renderer, const std::string& more) {
    return memory_of(testing::small_scenario(
                         {R"(cameras=[{"name":"a","width_px":1280,"height_px":960)" + more + "}]",
                          "renderer.camera=" + renderer}))
        .images_bytes;
  };
  const std::string lens =
      R"(,"distortion":{"model":"radtan","coefficients":[-0.2,0.04,0.001,-0.001]})";
  // Once in the run and once for viewers: a float, and two for the ray of each sample.
  EXPECT_EQ(bytes_of("egl", lens) - bytes_of("egl", ""), 2 * (4 + 8) * kPixels);
  EXPECT_EQ(bytes_of("egl", lens + R"(,"quality":"reference")") - bytes_of("egl", ""),
            2 * (4 + 4 * 8) * kPixels);
  EXPECT_EQ(bytes_of("raycast", lens), bytes_of("raycast", ""));
}

}  // namespace
}  // namespace overfly::server
