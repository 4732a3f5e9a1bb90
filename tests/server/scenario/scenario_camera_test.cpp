// Cameras, faults and light of a scenario: what a document means, and what it may not say.
#include "server/scenario/document/scenario_camera.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/motion/pose.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

Result<Scenario> resolved(const char* fields) {
  Json document = {{"format_version", 1},
                   {"world", {{"builtin", Json::object()}}},
                   {"flight", {{"course", Json::object()}}}};
  document.update(Json::parse(fields));
  return resolve_scenario(document, {}, "/base");
}

Scenario scenario(const char* fields) {
  Result<Scenario> read = resolved(fields);
  EXPECT_TRUE(read.ok()) << read.error().message;
  return read ? *read : Scenario{};
}

std::string error_of_fields(const char* fields) {
  const Result<Scenario> read = resolved(fields);
  return read ? "none" : read.error().message;
}

/// Where the optical axis and the image's top point, in the body (forward-right-down).
void expect_mount(const char* mount, const Eigen::Vector3d& axis, const Eigen::Vector3d& top) {
  const Scenario read = scenario((std::string(R"({"camera": {"mount": )") + mount + "}}").c_str());
  const Eigen::Quaterniond R_body_camera = read.cameras.front().T_body_camera.rotation;
  EXPECT_LT((R_body_camera * Eigen::Vector3d::UnitZ() - axis).norm(), 1e-12) << mount;
  EXPECT_LT((R_body_camera * -Eigen::Vector3d::UnitY() - top).norm(), 1e-12) << mount;
}

TEST(ScenarioCamera, MountsFaceWhereTheySay) {
  const Eigen::Vector3d forward = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d right = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d down = Eigen::Vector3d::UnitZ();
  expect_mount("{}", down, forward);
  expect_mount(R"({"facing": "forward"})", forward, -down);
  expect_mount(R"({"facing": "backward"})", -forward, -down);
  expect_mount(R"({"facing": "left"})", -right, -down);
  expect_mount(R"({"facing": "right"})", right, -down);
}

TEST(ScenarioCamera, MountAnglesTurnTheCameraAsTheAircraft) {
  const double c = std::cos(rad_from_deg(30.0));
  const double s = std::sin(rad_from_deg(30.0));
  // Nose up by 30 deg lifts the nadir axis forward, and a forward axis up.
  expect_mount(R"({"pitch_deg": 30})", {s, 0, c}, {c, 0, -s});
  expect_mount(R"({"facing": "forward", "pitch_deg": 30})", {c, 0, -s}, {-s, 0, -c});
  expect_mount(R"({"facing": "forward", "yaw_deg": 90})", {0, 1, 0}, {0, 0, -1});
  // Right wing down: the nadir axis swings to the left.
  expect_mount(R"({"roll_deg": 30})", {0, -s, c}, {1, 0, 0});
}

TEST(ScenarioCamera, ReadsLensAndPlaceOnTheAircraft) {
  const Scenario read = scenario(R"({"camera": {
    "fx_px": 500, "fy_px": 501, "width_px": 640, "height_px": 480, "color": "rgb",
    "quality": "reference", "atmosphere": {"visibility_km": 3.912},
    "distortion": {"model": "radtan", "coefficients": [-0.1, 0.01, 0.001, -0.001]},
    "mount": {"p_body_m": [0.5, -0.1, 0.2]}}})");
  const CameraSpec& camera = read.cameras.front();
  EXPECT_EQ(camera.name, "camera0");
  EXPECT_EQ(camera.model.distortion().model, DistortionModel::kRadtan);
  EXPECT_EQ(camera.model.distortion().k, (std::array<double, 5>{-0.1, 0.01, 0.001, -0.001, 0}));
  EXPECT_EQ(camera.T_body_camera.translation, Eigen::Vector3d(0.5, -0.1, 0.2));
  EXPECT_TRUE(camera.rgb);
  EXPECT_EQ(camera.quality, renderer::RenderQuality::kReference);
  EXPECT_NEAR(camera.atmosphere.extinction_per_m, 1e-3, 1e-15);
  EXPECT_FALSE(camera.sensor.enabled);
  EXPECT_FALSE(camera.vibration.enabled);
}

TEST(ScenarioCamera, ReadsTheSensorInUnitsForPeople) {
  const Scenario read = scenario(R"({"camera": {"bits": 12, "rate_hz": 30,
    "vibration": {"engine_rpm": 5000, "engine_rotation_rms_mrad": [1, 0.5],
                  "noise_translation_rms_mm": [0, 0, 2]},
    "sensor": {"exposure_ms": 4, "readout_ms": 20, "motion_blur": true, "vignette": [-0.3, 0, 0],
               "shot_noise": true, "read_noise_e": 7, "full_well_e": 11000,
               "response": {"shape": "gamma", "gamma": 2.2},
               "auto_exposure": {"max_exposure_ms": 8, "settle_frames": 6}}}})");
  const sensor::SensorModel& sensor = read.cameras.front().sensor;
  EXPECT_TRUE(sensor.enabled);
  EXPECT_DOUBLE_EQ(sensor.exposure_s, 4e-3);
  EXPECT_DOUBLE_EQ(sensor.readout_s, 20e-3);
  EXPECT_EQ(sensor.bits, 12);
  EXPECT_EQ(sensor.read_noise_e, 7.0);
  EXPECT_EQ(sensor.response.gamma, 2.2);
  ASSERT_TRUE(sensor.auto_exposure);
  EXPECT_DOUBLE_EQ(sensor.auto_exposure->max_exposure_s, 8e-3);
  EXPECT_EQ(sensor.auto_exposure->settle_frames, 6);
  const sensor::VibrationModel& vibration = read.cameras.front().vibration;
  EXPECT_TRUE(vibration.enabled);
  EXPECT_EQ(vibration.engine_rotation_rms_rad, (std::vector<double>{1e-3, 5e-4}));
  EXPECT_EQ(vibration.noise_translation_rms_m[2], 2e-3);
}

TEST(ScenarioCamera, SaysWhatOneFieldForbidsAnother) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {R"({"camera": {"bits": 10}})", "camera.bits = 10: must be 8 if camera.sensor is not"},
      {R"({"camera": {"rate_hz": 50, "sensor": {"exposure_ms": 21}}})",
       "camera.sensor.exposure_ms = 21: must be at most the frame's period, 20.0 ms"},
      {R"({"camera": {"rate_hz": 50, "sensor": {"readout_ms": 25}}})",
       "camera.sensor.readout_ms = 25: must be at most the frame's period"},
      {R"({"camera": {"rate_hz": 100, "sensor": {"auto_exposure": {}}}})",
       "camera.sensor.auto_exposure.max_exposure_ms = 20: must be at most"},
      {R"({"camera": {"sensor": {"response": {"shape": "gamma"}}}})",
       "camera.sensor.response.gamma: must be given with shape gamma"},
      {R"({"camera": {"sensor": {"response": {"shape": "srgb", "gamma": 2}}}})",
       "camera.sensor.response.gamma = 2: must go with shape gamma"},
      {R"({"camera": {"distortion": {"model": "equidistant", "coefficients": [0.1]}}})",
       "camera.distortion.coefficients = [0.1]: must have 4 values for equidistant"},
      {R"({"camera": {"distortion": {"model": "radtan", "coefficients": [-3, 0, 0, 0]}}})",
       "camera"},
      {R"({"camera": {"mount": {"q_xyzw": [0, 0, 0, 1], "roll_deg": 3}}})",
       "camera.mount.roll_deg = 3: must not be given with camera.mount.q_xyzw"},
      {R"({"camera": {"mount": {"q_xyzw": [0, 0, 0, 0.5]}}})",
       "camera.mount.q_xyzw = [0,0,0,0.5]: must have length 1"},
      {R"({"camera": {}, "cameras": [{}]})", "camera: must not be given with cameras"},
      {R"({"cameras": [{"name": "a"}, {"name": "a"}]})", "cameras.1.name = \"a\": must be unique"},
      {R"({"cameras": [{"name": "a"}, {"name": "b", "rate_hz": 5}]})",
       "cameras.1.rate_hz = 5: must be that of the first camera, 31.0"},
      {R"({"estimators": [{"name": "e", "type": "perfect", "camera": "tail"}]})",
       "estimators.0.camera = \"tail\": must be the name of a camera (camera0)"},
      {R"({"faults": [{"kind": "dirt", "at_s": 1, "camera": "tail"}]})",
       "faults.0.camera = \"tail\": must be the name of a camera (camera0)"},
      {R"({"faults": [{"kind": "frozen_frame", "at_s": 1, "every": 2}]})",
       "faults.0.every = 2: must not be given for frozen_frame"},
      {R"({"faults": [{"kind": "stamp_jitter", "at_s": 1}]})",
       "faults.0.sigma_ms: must be given for stamp_jitter"},
      {R"({"faults": [{"kind": "dropped_frames", "at_s": 1, "every": 2, "probability": 0.5}]})",
       "faults.0.every = 2: must not be given with faults.0.probability"},
      {R"({"faults": [{"kind": "dirt", "at_s": 1, "strength": 2}]})", "faults.0: strength = 2"},
      {R"({"light": {"time_utc": "2026-02-30T12:00Z"}})",
       "light.time_utc = \"2026-02-30T12:00Z\": must be a date and time that exist"},
      {R"({"light": {"time_utc": "4052-06-21T21:30Z"}})",
       "light.time_utc = \"4052-06-21T21:30Z\": must be in the years 1678 to 2261"},
      {R"({"light": {"time_utc": "1677-12-31T23:59Z"}})",
       "light.time_utc = \"1677-12-31T23:59Z\": must be in the years 1678 to 2261"},
      {R"({"light": {"time_utc": "2026-02-20T12:00Z", "sun_azimuth_deg": 1,
                     "sun_elevation_deg": 30}})",
       "light.time_utc = \"2026-02-20T12:00Z\": must not be given with light.sun_azimuth_deg"},
      {R"({"flight": {"log": {"file": "a.tum", "camera_poses": true}},
           "camera": {"mount": {"facing": "forward"}}})",
       "flight.log.camera_poses = true: the first camera must be mounted nadir"}};
  for (const auto& [fields, text] : cases)
    EXPECT_THAT(error_of_fields(fields), HasSubstr(text)) << fields;
}

TEST(ScenarioCamera, SeveralAreKnownByTheirNames) {
  const Scenario read = scenario(R"({
    "cameras": [{"name": "down"}, {"name": "ahead", "mount": {"facing": "forward"}}],
    "estimators": [{"name": "a", "type": "perfect"},
                   {"name": "b", "type": "perfect", "camera": "ahead"}],
    "faults": [{"kind": "blackout", "at_s": 1, "duration_s": 2, "camera": "ahead"},
               {"kind": "dropped_frames", "at_s": 0, "probability": 0.25}]})");
  ASSERT_EQ(read.cameras.size(), 2U);
  EXPECT_EQ(read.estimators[0].camera, 0U);
  EXPECT_EQ(read.estimators[1].camera, 1U);
  ASSERT_EQ(read.faults.size(), 2U);
  EXPECT_EQ(read.faults[0].camera, 1U);
  EXPECT_TRUE(read.faults[0].in_force(1, 1'000'000'000));
  EXPECT_FALSE(read.faults[0].in_force(0, 1'000'000'000));
  EXPECT_FALSE(read.faults[0].in_force(1, 3'000'000'000));
  EXPECT_TRUE(read.faults[1].in_force(0, 80'000'000'000'000));
  EXPECT_FALSE(read.resolved.contains("camera"));
}

TEST(ScenarioCamera, ACopyOfTheResolvedDocumentMeansTheSame) {
  const Scenario read = scenario(R"({
    "cameras": [{"name": "down", "sensor": {}}, {"name": "ahead", "vibration": {}}],
    "light": {"time_utc": "2026-06-21T17:30Z", "clouds": {"cover": 0.3}}, "detail": {},
    "renderer": {"camera": "raycast", "threads": 2},
    "faults": [{"kind": "dirt", "at_s": 1}]})");
  EXPECT_EQ(read.renderer.camera, "raycast");
  EXPECT_EQ(read.light->options.clouds.cover, 0.3);
  EXPECT_EQ(read.light->time_unix_ns, 1'782'063'000'000'000'000);
  EXPECT_EQ(read.detail->octaves, 2);
  const Result<Scenario> again = resolve_scenario(read.resolved, {}, "/elsewhere");
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(again->resolved, read.resolved);
}

}  // namespace
}  // namespace overfly::server
