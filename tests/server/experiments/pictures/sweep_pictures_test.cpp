// For which flights of a sweep pictures are kept, by a program that writes down its options.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tests/server/experiments/fly_sweep_fixture.hpp"

namespace overfly::server::experiments {
namespace {

using overfly::testing::read_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SweepPictures : public FlySweep {
 protected:
  /// Flies. @return how each flight uses the cache: "adds", "reads" or "none".
  std::vector<std::string> fly_with_cache(const Sweep& sweep, double budget_gib = 2.0) {
    std::filesystem::remove(words());
    write_program("echo \"$*\" >> '" + words().string() + "'");
    SweepOptions with_cache = options(1);
    with_cache.frame_cache = {cache(), budget_gib, 12345};
    flown_ = std::make_unique<Result<FlownSweep>>(fly_sweep(sweep, with_cache));
    EXPECT_TRUE(flown_->ok()) << (*flown_).error().message;
    std::vector<std::string> uses;
    if (!std::filesystem::exists(words())) return uses;
    std::istringstream lines(read_text(words()));
    for (std::string line; std::getline(lines, line);) {
      const std::string folder = " --frame-cache " + cache().string();
      const std::string since = " --frame-cache-since-ns 12345";
      if (line.ends_with(folder + " --frame-cache-gib 2" + since)) {
        uses.emplace_back("adds");
      } else if (line.ends_with(folder + " --frame-cache-gib 0" + since)) {
        uses.emplace_back("reads");
      } else {
        EXPECT_TRUE(line.ends_with("--quiet")) << line;
        uses.emplace_back("none");
      }
    }
    return uses;
  }
  [[nodiscard]] std::filesystem::path cache() const { return own_folder() / "frames"; }
  [[nodiscard]] std::filesystem::path words() const { return own_folder() / "words"; }

  std::unique_ptr<Result<FlownSweep>> flown_;
};

TEST_F(SweepPictures, ASweepWhoseFlightsAllDifferWritesNothing) {
  EXPECT_THAT(fly_with_cache(sweep(kTwoSpeeds)), ElementsAre("none", "none"));
  EXPECT_FALSE(std::filesystem::exists(cache()));
}

TEST_F(SweepPictures, WhatOthersLeftIsRead) {
  std::filesystem::create_directory(cache());
  EXPECT_THAT(fly_with_cache(sweep(kTwoSpeeds)), ElementsAre("reads", "reads"));
}

TEST_F(SweepPictures, RepeatsThatDifferInNoiseOnlyShareThem) {
  EXPECT_THAT(fly_with_cache(sweep(std::string(kTwoSpeeds) + R"(, "repeats": {"most": 2})")),
              ElementsAre("adds", "adds", "adds", "adds"));
}

TEST_F(SweepPictures, WithoutABudgetThereIsNone) {
  EXPECT_THAT(fly_with_cache(sweep(R"("axes": [], "repeats": {"most": 2})"), 0.0),
              ElementsAre("none", "none"));
}

TEST_F(SweepPictures, RepeatsWithOtherPicturesDoNot) {
  for (const char* repeats :
       {R"({"most": 2, "vary_world": true})", R"({"most": 2, "vary_start_s": 3})"}) {
    std::filesystem::remove_all(folder());
    EXPECT_THAT(fly_with_cache(sweep(R"("axes": [], "repeats": )" + std::string(repeats))),
                ElementsAre("none", "none"));
  }
  std::filesystem::remove_all(folder());
  EXPECT_THAT(
      fly_with_cache(sweep(
          R"("set": {"flight.course.dynamics": "piper_cub_third", "flight.course.turbulence": "light"},
             "axes": [], "repeats": {"most": 2})")),
      ElementsAre("none", "none"));
}

TEST_F(SweepPictures, CellsThatDifferInTheEstimatorOrTheNoiseShareThem) {
  EXPECT_THAT(fly_with_cache(sweep(
                  R"("set": {"camera.sensor": {}},
                     "axes": [{"path": "camera.sensor.read_noise_e", "values": [0, 10]},
                              {"path": "flight.course.airspeed_m_s", "values": [10, 25]}])")),
              ElementsAre("adds", "adds", "adds", "adds"));
}

TEST_F(SweepPictures, AFlightForAnAddedEstimatorKeepsThemForTheNextOne) {
  const std::string one = R"("axes": [{"name": "who", "variants": [{"value": "all", "set": {)";
  EXPECT_THAT(fly_with_cache(sweep(one + "}}]}]")), ElementsAre("none"));
  EXPECT_THAT(fly_with_cache(sweep(one + R"("estimators": [{"name": "p", "type": "perfect"},
                                                   {"name": "q", "type": "perfect"}]}}]}])")),
              ElementsAre("adds"));
}

/// The whole numbers of a range are the same values as in the results of the first flights.
TEST_F(SweepPictures, AnAddedEstimatorIsRecognisedOnRangesToo) {
  Sweep range = sweep(
      R"("axes": [{"path": "flight.course.airspeed_m_s", "from": 10, "to": 25, "step": 15}])");
  EXPECT_THAT(fly_with_cache(range), ElementsAre("none", "none"));
  range.changes.back().value = nlohmann::json::parse(
      R"([{"name": "p", "type": "perfect"}, {"name": "q", "type": "perfect"}])");
  EXPECT_THAT(fly_with_cache(range), ElementsAre("adds", "adds"));
}

TEST_F(SweepPictures, CountsPicturesAndWarnsOnceOfAProblem) {
  const Sweep two = sweep(R"("axes": [], "repeats": {"most": 3})");
  SweepOptions with_cache = options(1);
  with_cache.frame_cache = {cache(), 2.0, 1};
  // What the flights record, although the program in their place has no cache.
  write_program(
      "trap 'echo {\\\"frame_cache\\\":{\\\"read\\\":5,\\\"rendered\\\":2,"
      "\\\"problem\\\":\\\"disk\\\"}} > \"$4/timings.json\"' EXIT");
  const auto flown = fly_sweep(two, with_cache);
  ASSERT_TRUE(flown.ok()) << flown.error().message;
  EXPECT_EQ(flown->pictures.read, 15U);
  EXPECT_EQ(flown->pictures.rendered, 6U);
  EXPECT_THAT(warnings_, ElementsAre("frame cache: disk"));
}

}  // namespace
}  // namespace overfly::server::experiments
