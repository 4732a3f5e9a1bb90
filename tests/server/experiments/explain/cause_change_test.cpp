// Causes taken out of scenario documents.
#include "server/experiments/explain/cause_change.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/scenario/document/scenario_file.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;
using server::testing::small_scenario;
using ::testing::DoubleNear;

/// With one estimator, unless the overrides name others.
Json document(std::vector<std::string> overrides = {}) {
  overrides.insert(overrides.begin(), R"(estimators=[{"name":"p","type":"perfect"}])");
  return small_scenario(overrides).resolved;
}
Json without_cause(Json from, Cause cause) {
  change(from, without(cause));
  return from;
}
Json scaled(Json from, Cause cause, double share) {
  change(from, {cause, share});
  return from;
}
/// What is made of a document must be one that can be flown.
void expect_valid(const Json& made) {
  const auto scenario = resolve_scenario(made, {}, "/");
  EXPECT_TRUE(scenario.ok()) << (scenario.ok() ? "" : scenario.error().message);
}

constexpr const char* kFaults = R"(faults=[{"kind":"blackout","at_s":1,"duration_s":2},
                                           {"kind":"dropped_frames","at_s":1,"every":3},
                                           {"kind":"dropped_frames","at_s":2,"probability":0.5}])";

TEST(CauseNames, AreKnownInBothDirections) {
  EXPECT_EQ(all_causes().size(), 12U);
  for (const Cause cause : all_causes()) EXPECT_EQ(cause_from(to_string(cause)), cause);
  EXPECT_FALSE(cause_from("gremlins").has_value());
}

TEST(CauseChange, ACleanFlightHasNoDisturbance) {
  const Json clean = document({R"(estimators=[{"name":"f","type":"feature"}])"});
  for (const Cause cause : all_causes()) {
    EXPECT_EQ(why_unchangeable(clean, cause).has_value(), is_disturbance(cause))
        << to_string(cause);
  }
}

TEST(CauseChange, FaultsAndDropsAreApart) {
  const Json flown = document({kFaults, "duration_s=4"});
  const Json seen = without_cause(flown, Cause::kFaults);
  ASSERT_EQ(seen.at("faults").size(), 3U) << "the others keep their places and random numbers";
  EXPECT_EQ(seen.at("faults").at(0).at("at_s"), 86400.0);
  EXPECT_TRUE(why_unchangeable(seen, Cause::kFaults).has_value());
  EXPECT_EQ(resolve_scenario(seen, {}, "/")->faults.at(2).seed,
            resolve_scenario(flown, {}, "/")->faults.at(2).seed);
  const Json all = without_cause(flown, Cause::kDrops);
  ASSERT_EQ(all.at("faults").size(), 1U);
  EXPECT_EQ(all.at("faults").at(0).at("kind"), "blackout");
  expect_valid(seen);
  expect_valid(all);

  const Json half = scaled(flown, Cause::kDrops, 0.5);
  EXPECT_EQ(half.at("faults").at(1).at("every"), 6);
  EXPECT_EQ(half.at("faults").at(2).at("probability"), 0.25);
  EXPECT_EQ(scaled(flown, Cause::kFaults, 0.25).at("faults").at(0).at("duration_s"), 0.5);
  EXPECT_TRUE(can_scale(flown, Cause::kFaults));
  EXPECT_FALSE(can_scale(document({R"(faults=[{"kind":"blackout","at_s":1}])"}), Cause::kFaults))
      << "it lasts to the end";
}

TEST(CauseChange, RealTimeDropsGoInLockstep) {
  const Json live = document({"pacing=real_time"});
  EXPECT_FALSE(why_unchangeable(live, Cause::kDrops).has_value());
  EXPECT_FALSE(can_scale(live, Cause::kDrops));
  EXPECT_EQ(without_cause(live, Cause::kDrops).at("pacing"), "lockstep");
}

TEST(CauseChange, TheSensorsStagesGoOneByOne) {
  const Json flown =
      document({R"(camera.sensor={"motion_blur":true,"exposure_ms":8,"defocus_sigma_px":2,
      "readout_ms":12,"shot_noise":true,"read_noise_e":20,"prnu":0.04,"gain_dn_per_e":0.5,
      "vignette":[-0.2,0,0]})"});
  const auto sensor_without = [&](Cause cause) {
    const Json made = without_cause(flown, cause);
    expect_valid(made);
    return made.at("camera").at("sensor");
  };
  const Json sharp = sensor_without(Cause::kBlur);
  EXPECT_EQ(sharp.at("motion_blur"), false);
  EXPECT_EQ(sharp.at("defocus_sigma_px"), 0.0);
  EXPECT_EQ(sharp.at("exposure_ms"), 8);
  EXPECT_EQ(sensor_without(Cause::kRollingShutter).at("readout_ms"), 0.0);
  const Json quiet = sensor_without(Cause::kNoise);
  EXPECT_EQ(quiet.at("shot_noise"), false);
  EXPECT_EQ(quiet.at("read_noise_e"), 0.0);
  EXPECT_EQ(quiet.at("prnu"), 0.0);
  const Json exposed = sensor_without(Cause::kExposure);
  EXPECT_EQ(exposed.at("gain_dn_per_e"), 0.0);
  EXPECT_FALSE(exposed.contains("vignette"));
}

/// A quarter of the blur has the brightness and the shot noise of the whole.
TEST(CauseChange, ScalesBlurAtEqualLight) {
  const Json flown =
      document({R"(camera.sensor={"motion_blur":true,"exposure_ms":8,"defocus_sigma_px":2})"});
  const Json sensor = scaled(flown, Cause::kBlur, 0.25).at("camera").at("sensor");
  EXPECT_EQ(sensor.at("exposure_ms"), 2.0);
  EXPECT_EQ(sensor.at("defocus_sigma_px"), 0.5);
  EXPECT_EQ(sensor.at("exposure_ms").get<double>() * sensor.at("electrons_per_s").get<double>(),
            8.0 * 5'000'000);
}

/// Relative to the light: shot noise 1 / sqrt(N), read noise r / N.
TEST(CauseChange, ScalesEveryKindOfNoise) {
  const Json flown = document(
      {R"(camera.sensor={"shot_noise":true,"read_noise_e":40,"prnu":0.04,"electrons_per_s":1e6})"});
  const Json sensor = scaled(flown, Cause::kNoise, 0.5).at("camera").at("sensor");
  const double light = sensor.at("electrons_per_s").get<double>() / 1e6;
  EXPECT_THAT(1.0 / std::sqrt(light), DoubleNear(0.5, 1e-12));
  EXPECT_THAT(sensor.at("read_noise_e").get<double>() / light, DoubleNear(20.0, 1e-12));
  EXPECT_THAT(sensor.at("prnu").get<double>(), DoubleNear(0.02, 1e-12));
}

TEST(CauseChange, ChangesWhatEveryFlightHas) {
  const Json flown = document({R"(estimators=[{"name":"f","type":"feature"}])"});
  EXPECT_EQ(
      without_cause(flown, Cause::kFeatures).at("estimators").at(0).at("parameters").at("features"),
      4000);
  EXPECT_TRUE(without_cause(flown, Cause::kTexture).contains("detail"));
  EXPECT_EQ(
      without_cause(flown, Cause::kRollRate).at("flight").at("course").at("roll_rate_max_deg_s"),
      flown.at("flight").at("course").at("roll_rate_max_deg_s").get<double>() / 2);
  EXPECT_GT(without_cause(flown, Cause::kStart).value("start_s", 0.0), 0.0);
  for (const Cause cause : all_causes()) {
    if (!is_disturbance(cause)) expect_valid(without_cause(flown, cause));
  }
}

TEST(CauseChange, KnowsTheFeaturesOfOtherEstimators) {
  const Json flown = document(
      {R"(estimators=[{"name":"o","type":"process","command":["true"],"parameters":{"ORBextractor.nFeatures":1500}}])"});
  const Json made = without_cause(flown, Cause::kFeatures);
  EXPECT_EQ(made.at("estimators").at(0).at("parameters").at("ORBextractor.nFeatures"), 3000);
  const Json other = document({R"(estimators=[{"name":"p","type":"perfect"}])"});
  EXPECT_TRUE(why_unchangeable(other, Cause::kFeatures).has_value());
}

TEST(CauseChange, TheCameraIsThatOfTheEstimator) {
  const Json flown = document({R"(cameras=[{"name":"a","width_px":64,"height_px":48},
      {"name":"b","width_px":64,"height_px":48,"sensor":{"readout_ms":9}}])",
                               R"(estimators=[{"name":"p","type":"perfect","camera":"b"}])"});
  EXPECT_FALSE(why_unchangeable(flown, Cause::kRollingShutter).has_value());
  const Json made = without_cause(flown, Cause::kRollingShutter);
  EXPECT_EQ(made.at("cameras").at(1).at("sensor").at("readout_ms"), 0.0);
}

TEST(CauseSuspicion, AFaultThatIsActiveComesFirst) {
  const Json flown = document({R"(faults=[{"kind":"blackout","at_s":1,"duration_s":2}])",
                               R"(camera.sensor={"motion_blur":true})"});
  EXPECT_GT(suspicion(flown, Cause::kFaults, 4.0), suspicion(flown, Cause::kBlur, 4.0));
  EXPECT_LT(suspicion(flown, Cause::kFaults, 30.0), suspicion(flown, Cause::kBlur, 30.0));
}

}  // namespace
}  // namespace overfly::server::experiments
