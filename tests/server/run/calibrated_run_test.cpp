// Runs whose estimators get the intrinsics of a calibration with a virtual board.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/outside/file_text.hpp"
#include "server/estimators/estimator_factory.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_manifest.hpp"
#include "server/run/run_options.hpp"
#include "tests/renderer/procedural_ground.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kLens = R"({"model":"radtan","coefficients":[-0.2,0.03,0.001,-0.0005]})";

/// Keeps the intrinsics that it was given.
class Listener final : public VoPort {
 public:
  struct Heard {
    std::optional<CameraModel> prepared;
    std::vector<CameraModel> frames;
  };
  explicit Listener(Heard& heard) : heard_(heard) {}
  std::string type() const override { return "listener"; }
  std::map<std::string, std::string> effective_parameters() const override { return {}; }
  Status prepare(const VoFrame& first) override {
    heard_.prepared = CameraModel(first.intrinsics, first.distortion);
    return {};
  }
  Result<VoEstimate> track(const VoFrame& frame) override {
    heard_.frames.emplace_back(frame.intrinsics, frame.distortion);
    VoEstimate estimate;
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    return estimate;
  }
  void set_debug(bool /*wanted*/) override {}

 private:
  Heard& heard_;
};

struct CalibratedFlight {
  overfly::testing::TemporaryFolder folder;
  std::vector<std::string> overrides = {
      R"(camera={"width_px":640,"height_px":480,"rate_hz":4,"calibrated":true})",
      std::string("camera.distortion=") + kLens,
      "duration_s=1",
      R"(estimators=[{"name":"f","type":"feature"}])"};
  Listener::Heard heard;
  std::vector<std::string> notices;

  [[nodiscard]] Result<RunResult> fly(const std::string& name = "r",
                                      const std::atomic<bool>* cancel = nullptr) {
    RunOptions options;
    options.folder = folder.path() / name;
    options.renderer_factory = testing::noop_factory();
    options.cancel = cancel;
    options.notice = [this](const std::string& line) { notices.push_back(line); };
    options.estimator_factory = [this](const EstimatorSpec&) {
      return Result<std::unique_ptr<VoPort>>(std::make_unique<Listener>(heard));
    };
    return run_scenario(testing::small_scenario(overrides), options);
  }
  [[nodiscard]] json manifest(const std::string& name = "r") const {
    return read_json(manifest_file(folder.path() / name)).value();
  }
};

TEST(CalibratedRun, EstimatorsGetTheEstimateAndTheRecordHasBoth) {
  CalibratedFlight flight;
  const auto run = flight.fly();
  ASSERT_TRUE(run) << run.error().message;
  const auto scenario = testing::small_scenario(flight.overrides);
  const CameraModel& truth = scenario.cameras.front().model;

  ASSERT_TRUE(flight.heard.prepared);
  ASSERT_FALSE(flight.heard.frames.empty());
  const CameraModel& given = *flight.heard.prepared;
  const PinholeCamera& k = given.pinhole();
  const PinholeCamera& real = truth.pinhole();
  EXPECT_EQ(flight.heard.frames.back().pinhole().fx_px, k.fx_px);
  EXPECT_EQ(flight.heard.frames.back().distortion().k, given.distortion().k);
  EXPECT_NE(k.fx_px, real.fx_px);
  // The accuracy of docs/CALIBRATION.md for 640 x 480 px and fewer views than there.
  EXPECT_NEAR(k.fx_px, real.fx_px, 0.003 * real.fx_px);
  EXPECT_NEAR(k.cx_px, real.cx_px, 1.0);
  EXPECT_NEAR(given.distortion().k[0], -0.2, 0.01);

  const json camera = flight.manifest().at("cameras").at(0);
  EXPECT_EQ(camera.at("fx_px"), real.fx_px);
  const json& calibrated = camera.at("calibrated");
  EXPECT_EQ(calibrated.at("fx_px"), k.fx_px);
  EXPECT_EQ(calibrated.at("distortion").at("coefficients").at(0), given.distortion().k[0]);
  const json& difference = calibrated.at("difference");
  EXPECT_DOUBLE_EQ(difference.at("fx_px").get<double>(), k.fx_px - real.fx_px);
  EXPECT_DOUBLE_EQ(difference.at("cy_px").get<double>(), k.cy_px - real.cy_px);
  // A ray of the true camera, projected by the other: between the mean and the largest distance.
  const Eigen::Vector2d corner(0.0, 0.0);
  const double apart_px = (*given.project(*truth.ray(corner)) - corner).norm();
  EXPECT_LE(apart_px, difference.at("projection_max_px").get<double>() + 1e-12);
  EXPECT_GT(difference.at("projection_max_px").get<double>(),
            difference.at("projection_mean_px").get<double>());
  EXPECT_LT(difference.at("projection_mean_px").get<double>(), 1.0);
  // The error is of the size that the calibration announces.
  EXPECT_LT(std::abs(k.fx_px - real.fx_px),
            5.0 * calibrated.at("standard_deviation").at("fx_px").get<double>());

  const auto read = read_run_manifest(flight.folder.path() / "r");
  ASSERT_TRUE(read && read->violations.empty()) << (read ? read->problem() : read.error().message);
  EXPECT_EQ(json_from(read->values), flight.manifest());
  const auto log = read_file_text(log_file(flight.folder.path() / "r"), 1U << 20U);
  EXPECT_THAT(*log, HasSubstr("camera camera0, as calibrated: fx"));
  EXPECT_THAT(flight.notices.front(), HasSubstr("calibrating camera \"camera0\": image 1 of 20"));
}

TEST(CalibratedRun, IsTheSameForEqualSeedsAndAnotherForOthers) {
  CalibratedFlight flight;
  flight.overrides.push_back(R"(camera.calibrated={"views":10})");
  flight.overrides.push_back(R"(camera.sensor={"shot_noise":true,"defocus_sigma_px":0.7})");
  ASSERT_TRUE(flight.fly("a"));
  ASSERT_TRUE(flight.fly("b"));
  EXPECT_EQ(flight.manifest("a"), flight.manifest("b"));
  flight.overrides.push_back("seed=77");
  ASSERT_TRUE(flight.fly("c"));
  EXPECT_NE(flight.manifest("a").at("cameras").at(0).at("calibrated").at("fx_px"),
            flight.manifest("c").at("cameras").at(0).at("calibrated").at("fx_px"));
}

TEST(CalibratedRun, AutoExposureSettlesBeforeTheFirstView) {
  CalibratedFlight flight;
  flight.overrides.push_back(R"(camera.calibrated={"views":8})");
  // 100 times less light than the first exposure is made for.
  flight.overrides.push_back(
      R"(camera.sensor={"electrons_per_s":5e4,"gain_dn_per_e":0.0255,"auto_exposure":{}})");
  const auto run = flight.fly();
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(flight.manifest().at("cameras").at(0).at("calibrated").at("views"), 8);
}

TEST(CalibratedRun, TheModelIsChosenOrFollowsTheLens) {
  const auto model_of = [](const std::vector<std::string>& overrides) {
    const Scenario scenario = testing::small_scenario(overrides);
    return scenario.cameras.front().calibrated->model;
  };
  const std::string asked = "camera.calibrated=true";
  const std::string fov = R"(camera.distortion={"model":"fov","coefficients":[0.8]})";
  EXPECT_EQ(model_of({asked}), DistortionModel::kRadtan);
  EXPECT_EQ(model_of({asked, fov}), DistortionModel::kEquidistant);
  EXPECT_EQ(model_of({R"(camera.calibrated={"model":"none"})"}), DistortionModel::kNone);
  EXPECT_FALSE(testing::small_scenario({"camera.calibrated=false"}).cameras.front().calibrated);
}

TEST(CalibratedRun, AWrongModelShowsInTheRecord) {
  CalibratedFlight flight;
  flight.overrides.push_back(R"(camera.calibrated={"model":"none","views":8})");
  const auto run = flight.fly();
  ASSERT_TRUE(run) << run.error().message;
  const json calibrated = flight.manifest().at("cameras").at(0).at("calibrated");
  EXPECT_GT(calibrated.at("difference").at("projection_max_px").get<double>(), 5.0);
  EXPECT_GT(calibrated.at("rms_px").get<double>(), 0.3);
}

TEST(CalibratedRun, NamesTheCameraThatCannotBeCalibrated) {
  CalibratedFlight flight;
  flight.overrides = {R"(camera={"width_px":40,"height_px":30,"rate_hz":4,"calibrated":true})",
                      "duration_s=1"};
  const auto run = flight.fly();
  ASSERT_FALSE(run);
  EXPECT_THAT(run.error().message, HasSubstr("calibrating camera \"camera0\""));
  EXPECT_THAT(run.error().message, HasSubstr("images give a view"));
}

TEST(CalibratedRun, IsCancelled) {
  CalibratedFlight flight;
  const std::atomic<bool> cancel{true};
  const auto run = flight.fly("r", &cancel);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->info.status, RunStatus::kCancelled);
}

TEST(CalibratedRun, RejectsWhatCannotBe) {
  const auto error_of = [](const std::vector<std::string>& overrides) {
    try {
      (void)testing::small_scenario(overrides);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(error_of({R"(camera.calibrated={"views":3})"}),
              HasSubstr("camera.calibrated.views = 3: must be in [4, 200]"));
  EXPECT_THAT(error_of({"camera.calibrated=\"yes\""}),
              HasSubstr("must be exactly one of true or false, {model, views}"));
  EXPECT_THAT(error_of({"camera.calibrated=true", R"(camera.images={"source":"x"})"}),
              HasSubstr("camera.calibrated: must not be given with camera.images"));
}

TEST(CalibratedRun, TheNativeEstimatorTracksWithIt) {
  const overfly::testing::TemporaryFolder folder;
  const Scenario scenario = testing::small_scenario(
      {R"(camera={"width_px":480,"height_px":360,"rate_hz":8,"calibrated":true})",
       std::string("camera.distortion=") + kLens,
       R"(flight.course.start={"east_m":0,"north_m":200})",
       "duration_s=5",
       R"(estimators=[{"name":"f","type":"feature","parameters":{"features":800}}])"});
  RunOptions options;
  options.folder = folder.path() / "r";
  options.renderer_factory = [](const auto&) {
    return Result<std::unique_ptr<renderer::Renderer>>(
        renderer::create_raycast_renderer(overfly::testing::natural_ground()));
  };
  const auto run = run_scenario(scenario, options);
  ASSERT_TRUE(run) << run.error().message;
  const evaluation::Score& score = run->metrics.estimators.at("f").score;
  EXPECT_STREQ(evaluation::to_string(score.outcome), "COMPLETED");
  // Over 125 m; the limit of LensRun, whose intrinsics are exact.
  EXPECT_LT(score.alignments.at(evaluation::AlignmentMode::kSim3).position_m.rmse, 0.12);
}

}  // namespace
}  // namespace overfly::server
