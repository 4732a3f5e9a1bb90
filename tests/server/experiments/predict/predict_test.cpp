// Patches against whole images, blur against closed forms, and whole predictions over small worlds.
#include "server/experiments/predict/predict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "server/experiments/predict/features/instant_features.hpp"
#include "server/experiments/predict/features/patch_camera.hpp"
#include "server/experiments/predict/prediction_json.hpp"
#include "server/experiments/predict/prediction_page.hpp"
#include "server/experiments/predict/prediction_words.hpp"
#include "server/experiments/predict/risk_model.hpp"
#include "tests/server/missions/level_world.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server::predict {
namespace {

using server::testing::small_scenario;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kFocalPx = 500.0;
constexpr double kHeightM = 200.0;

class PatchCameraTest : public ::testing::Test {
 protected:
  PatchCameraTest() {
    spec_.model = CameraModel(PinholeCamera{640, 480, kFocalPx, kFocalPx, 319.5, 239.5});
  }
  /// Straight and level at 20 m/s to the north, turning with a rate about the vertical.
  [[nodiscard]] std::vector<AircraftState> states(std::int64_t half_ns, double rate_rad_s = 0.0) {
    std::vector<AircraftState> states;
    for (std::int64_t t_ns = -half_ns; t_ns <= half_ns; t_ns += 1'000'000) {
      AircraftState state;
      state.t_ns = t_ns;
      const double t_s = 1e-9 * static_cast<double>(t_ns);
      state.T_world_body = {R_world_body_from({0.0, 0.0, rate_rad_s * t_s}),
                            {0.0, 0.0, tiles_->ground_up_m(0.0, 0.0) + kHeightM}};
      states.push_back(state);
    }
    return states;
  }
  [[nodiscard]] PatchShot shot(PatchCamera& camera, double rate_rad_s = 0.0) {
    return camera.expose(states(camera.half_window_ns(), rate_rad_s), 0, 0, *renderer_).value();
  }

  server::testing::LevelWorld world_;
  std::shared_ptr<const terrain::TileSource> tiles_ = world_.world().tiles;
  std::unique_ptr<renderer::Renderer> renderer_ = renderer::create_raycast_renderer(tiles_);
  CameraSpec spec_;
};

TEST_F(PatchCameraTest, PatchesArePartsOfTheImage) {
  const auto camera = PatchCamera::create(spec_, 0, 1, kFlightPatches).value();
  const PatchShot patches = shot(*camera);
  ASSERT_EQ(patches.patches.size(), 9U);
  const Pose T_world_camera = states(0).front().T_world_body * spec_.T_body_camera;
  const renderer::CameraFrame whole =
      renderer_->render_camera(spec_.model, T_world_camera, 0, renderer::PixelFormat::kGrey8)
          .value();
  int largest = 0;
  for (int i = 0; i < 9; ++i) {
    const Image& patch = patches.patches[static_cast<std::size_t>(i)];
    ASSERT_EQ(patch.width_px, 96);
    ASSERT_EQ(patch.height_px, 96);
    const int left = ((2 * (i % 3) + 1) * 640 / 3 - 96) / 2;
    const int top = ((2 * (i / 3) + 1) * 480 / 3 - 96) / 2;
    for (int y = 0; y < 96; ++y) {
      for (int x = 0; x < 96; ++x) {
        largest = std::max(largest, std::abs(patch.at(x, y) - whole.image.at(left + x, top + y)));
      }
    }
  }
  EXPECT_LE(largest, 2);
  // 200 m / 500 px on the ground, texels of 4 m.
  EXPECT_NEAR(patches.texels_per_pixel, 0.1, 1e-3);
  EXPECT_EQ(patches.void_share, 0.0);
  EXPECT_EQ(patches.noise_grey, 0.0);
}

TEST_F(PatchCameraTest, NoiseIsThatOfTheSensor) {
  spec_.sensor.enabled = true;
  spec_.sensor.response = sensor::ResponseCurve::linear();
  // Full scale is 10 000 electrons, so 200 electrons are 200 / 10 000 * 255 grey levels.
  spec_.sensor.electrons_per_s = 5e6;
  spec_.sensor.exposure_s = 2e-3;
  spec_.sensor.read_noise_e = 200.0;
  const auto camera = PatchCamera::create(spec_, 0, 1, kFlightPatches).value();
  // Quantisation adds a variance of 1 / 12.
  EXPECT_NEAR(shot(*camera).noise_grey, std::sqrt(5.1 * 5.1 + 1.0 / 12.0), 0.15);
}

TEST_F(PatchCameraTest, BlurIsRotationDuringTheExposure) {
  spec_.sensor.enabled = true;
  spec_.sensor.motion_blur = true;
  spec_.sensor.exposure_s = 20e-3;
  const auto camera = PatchCamera::create(spec_, 0, 1, kFlightPatches).value();
  constexpr double kRateRadS = 1.0;
  const PatchShot turning = shot(*camera, kRateRadS);
  const Pose T_world_camera = turning.T_world_camera.at(0);
  const ViewPoses still{T_world_camera, T_world_camera, T_world_camera};
  const Features features = features_of(spec_.model, turning, 0, still, *tiles_, {});
  // RMS radius of the grid's points (view_features_test.cpp).
  const double radius_px = std::sqrt(2.0 * 128.0 * 128.0 + 2.0 * 96.0 * 96.0);
  EXPECT_NEAR(features.blur_px, 0.02 * kRateRadS * radius_px, 0.02);
  const PatchShot straight = shot(*camera);
  const Features sharp = features_of(spec_.model, straight, 0, still, *tiles_, {});
  EXPECT_NEAR(sharp.blur_px, 0.0, 1e-6);
  EXPECT_EQ(sharp.overlap, 1.0);
  EXPECT_NEAR(sharp.relief, 0.0, 1e-4);
}

TEST_F(PatchCameraTest, DefocusLeavesFewerCorners) {
  const auto corners_with = [&](double sigma_px) {
    spec_.sensor.enabled = true;
    spec_.sensor.defocus_sigma_px = sigma_px;
    const auto camera = PatchCamera::create(spec_, 0, 1, kFlightPatches).value();
    // From 2000 m a pixel is a texel.
    std::vector<AircraftState> high = states(0);
    high.front().T_world_body.translation.z() += 1800.0;
    const PatchShot taken = camera->expose(high, 0, 0, *renderer_).value();
    const Pose T_world_camera = taken.T_world_camera.at(0);
    return features_of(
               spec_.model, taken, 0, {T_world_camera, T_world_camera, T_world_camera}, *tiles_, {})
        .corners_per_kpx;
  };
  const double sharp = corners_with(0.0);
  EXPECT_GT(sharp, 1.0);
  EXPECT_LT(corners_with(4.0), 0.5 * sharp);
}

TEST(Predict, FollowsTheFlight) {
  const Scenario scenario = small_scenario();
  PredictOptions options;
  options.map.reset();
  const Predicted predicted = predict(scenario, options).value();
  const Prediction& prediction = predicted.prediction;
  EXPECT_FALSE(prediction.map.has_value());
  ASSERT_EQ(prediction.instants.size(), 5U);  // 0 to 2 s, twice a second
  EXPECT_EQ(prediction.instants.back().t_s, 2.0);
  for (const PredictedInstant& instant : prediction.instants) {
    // 25 m/s at 300 m: f / 300 m * 25 m/s / 10 Hz.
    const double focal_px = scenario.cameras[0].model.pinhole().fx_px;
    EXPECT_NEAR(instant.height_agl_m, 300.0, 15.0);
    EXPECT_NEAR(instant.features.translation_px, focal_px * 2.5 / 300.0, 0.1);
    EXPECT_NEAR(instant.features.texels_per_pixel, 300.0 / focal_px / 2.0, 0.1);
    EXPECT_EQ(instant.features.noise_grey, 0.0);
    EXPECT_FALSE(instant.features.sun_elevation_deg.has_value());
    EXPECT_GT(instant.risk, 0.0);
    EXPECT_LT(instant.risk, 1.0);
  }
  EXPECT_EQ(prediction.risk, prediction.instants.back().risk_so_far);
}

TEST(Predict, JudgesNoFlightAsAWholeThatIsLongerThanThoseOfTheModel) {
  PredictOptions options;
  options.map.reset();
  options.rate_hz = 0.5;
  const Prediction prediction =
      predict(small_scenario({"duration_s=21"}), options).value().prediction;
  EXPECT_FALSE(prediction.risk.has_value());
  EXPECT_TRUE(json_from(prediction).at("risk").is_null());
  EXPECT_FALSE(json_from(prediction).at("instants").back().contains("risk_so_far"));
  EXPECT_THAT(sentences_of(prediction)[0], StartsWith("Parts of this flight of 21.0 s are ranked"));
}

TEST(Predict, DoesNotDependOnTheNumberOfThreads) {
  const Scenario scenario = small_scenario({"duration_s=15"});
  PredictOptions options;
  options.map = PredictOptions::Map{400.0, 100.0, false};
  const auto one = json_from(predict(scenario, options).value().prediction);
  options.jobs = 3;
  EXPECT_EQ(one, json_from(predict(scenario, options).value().prediction));
}

TEST(Predict, MapsTheImageryAroundTheFlight) {
  PredictOptions options;
  options.map = PredictOptions::Map{10'000.0, 100.0, true};
  options.jobs = 2;
  const Predicted predicted = predict(small_scenario(), options).value();
  ASSERT_TRUE(predicted.prediction.map.has_value());
  const RiskMap& map = *predicted.prediction.map;
  // The world has a side of 600 m; its corners are not exactly in the axes' directions.
  EXPECT_GE(map.columns, 6U);
  EXPECT_LE(map.columns, 7U);
  EXPECT_EQ(map.risk.size(), map.columns * map.rows);
  EXPECT_NEAR(map.height_agl_m, 300.0, 15.0);
  EXPECT_NEAR(map.speed_m_s, 25.0, 0.5);
  const auto& middle = map.risk[map.index(map.columns / 2, map.rows / 2)];
  ASSERT_TRUE(middle.has_value());
  EXPECT_EQ(predicted.ground.channels, 3);
  EXPECT_EQ(std::max(predicted.ground.width_px, predicted.ground.height_px), 1000);
}

TEST(Predict, BlurRaisesTheRisk) {
  PredictOptions options;
  options.map.reset();
  const auto risk_with = [&](const std::string& exposure_ms) {
    const Scenario scenario = small_scenario({"camera.sensor.motion_blur=true",
                                              "camera.sensor.exposure_ms=" + exposure_ms,
                                              "flight.course.height_agl_m=30",
                                              "flight.course.airspeed_m_s=60"});
    return predict(scenario, options).value().prediction;
  };
  const Prediction sharp = risk_with("0.5");
  const Prediction blurred = risk_with("90");
  EXPECT_GT(blurred.instants[2].features.blur_px, 10.0);
  EXPECT_LT(sharp.instants[2].features.blur_px, 1.0);
  EXPECT_GT(blurred.risk, sharp.risk);
}

TEST(Predict, KnowsTheSun) {
  PredictOptions options;
  options.map.reset();
  const Scenario scenario =
      small_scenario({"light.sun_azimuth_deg=90", "light.sun_elevation_deg=25"});
  const Predicted predicted = predict(scenario, options).value();
  EXPECT_NEAR(predicted.prediction.instants[0].features.sun_elevation_deg.value(), 25.0, 1e-9);
}

TEST(Predict, RefusesWhatItCannotPredict) {
  PredictOptions options;
  options.camera = "absent";
  const auto absent = predict(small_scenario(), options);
  ASSERT_FALSE(absent);
  EXPECT_THAT(absent.error().message, HasSubstr("--camera = \"absent\""));
  options.camera.clear();
  options.map = PredictOptions::Map{10'000.0, 1.0, false};
  const auto fine = predict(small_scenario(), options);
  ASSERT_FALSE(fine);
  EXPECT_THAT(fine.error().message, HasSubstr("cells: must be at most 250"));
  std::atomic<bool> cancel{true};
  options.map.reset();
  options.cancel = &cancel;
  const auto cancelled = predict(small_scenario(), options);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::kCancelled);
}

/// Five instants, of which the second and third are risky by blur.
Prediction risky_prediction() {
  Prediction prediction;
  prediction.duration_s = 2.0;
  prediction.step_s = 0.5;
  prediction.risk = 0.75;
  prediction.instants.resize(5);
  for (std::size_t k = 0; k < 5; ++k) {
    PredictedInstant& instant = prediction.instants[k];
    instant.t_s = 0.5 * static_cast<double>(k);
    instant.window = fitted_model().mean;
    instant.risk = k == 1 ? 0.6 : k == 2 ? 0.9 : 0.1;
    instant.window[8] = std::log1p(70.0);  // of 70 px
    instant.contributions[8] = 1.5;
    instant.contributions[0] = 1.0;  // not worse than the mean: no reason
  }
  return prediction;
}

TEST(PredictionWords, SayWhenAndWhy) {
  const Prediction prediction = risky_prediction();
  const auto stretches = risky_stretches(prediction);
  ASSERT_EQ(stretches.size(), 1U);
  EXPECT_EQ(stretches[0].first, 1U);
  EXPECT_EQ(stretches[0].last, 2U);
  EXPECT_EQ(stretches[0].worst, 2U);
  const auto sentences = sentences_of(prediction);
  EXPECT_THAT(sentences[0], HasSubstr("with a probability of 75 %"));
  EXPECT_EQ(sentences[1],
            "Risky at 0.5 s to 1.0 s: up to 90 % within 10 s, because of motion blur (70 px).");
}

TEST(PredictionWords, SayThatNothingIsRisky) {
  Prediction prediction = risky_prediction();
  for (PredictedInstant& instant : prediction.instants) instant.risk = 0.2;
  prediction.instants[3].risk = 0.3;
  EXPECT_THAT(sentences_of(prediction)[1],
              StartsWith("No part of it is risky; the highest risk is at 1.5 s: up to 30 %"));
}

TEST(PredictionWords, HeightsOfThreeDigitsHaveNoExponent) {
  Prediction prediction = risky_prediction();
  RiskMap& map = prediction.map.emplace();
  map.columns = 1;
  map.rows = 1;
  map.risk = {0.2};
  map.height_agl_m = 99.4;
  EXPECT_THAT(sentences_of(prediction).back(), HasSubstr("at 99 m over"));
  for (const double height_agl_m : {99.5, 99.99, 100.4}) {
    map.height_agl_m = height_agl_m;
    EXPECT_THAT(sentences_of(prediction).back(), HasSubstr("at 100 m over")) << height_agl_m;
  }
}

TEST(PredictionPage, ColoursCellsWithImagery) {
  RiskMap map;
  map.columns = 2;
  map.rows = 1;
  map.risk = {0.9, std::nullopt};
  map.features.resize(2);
  const Image picture = coloured_map(map, Image(10, 4, 3, 100));
  const RiskColour& high = kRiskColours.back();
  EXPECT_EQ(picture.at(0, 0, 0), std::lround(0.45 * 100 + 0.55 * high.rgb[0]));
  EXPECT_EQ(picture.at(9, 0, 0), 100) << "no imagery";
  EXPECT_EQ(&colour_of(0.0), &kRiskColours.front());
  EXPECT_EQ(&colour_of(0.2), &kRiskColours[2]);
  EXPECT_EQ(&colour_of(1.0), &kRiskColours.back());
}

TEST(PredictionPage, StandsAlone) {
  PredictOptions options;
  options.map = PredictOptions::Map{10'000.0, 100.0, true};
  Scenario scenario = small_scenario();
  scenario.title = "Low & <slow>";
  const Predicted predicted = predict(scenario, options).value();
  const std::string page = page_of(predicted.prediction, predicted.ground).value();
  EXPECT_THAT(page, HasSubstr("<h1>Risk: Low &amp; &lt;slow&gt;</h1>"));
  EXPECT_THAT(page, HasSubstr("data:image/jpeg;base64,"));
  EXPECT_THAT(page, HasSubstr("risk [%]"));
  EXPECT_THAT(page, HasSubstr("50 to 80 %"));
  EXPECT_EQ(page.find("<script"), std::string::npos);
  const std::regex svg_namespace("xmlns=\"http://www.w3.org/2000/svg\"");
  EXPECT_EQ(std::regex_replace(page, svg_namespace, "").find("://"), std::string::npos)
      << "nothing is loaded";
}

}  // namespace
}  // namespace overfly::server::predict
