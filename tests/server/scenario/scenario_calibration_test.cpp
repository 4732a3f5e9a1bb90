// Cameras of a scenario whose intrinsics come from a calibration file.
#include "server/scenario/document/scenario_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/scenario/document/scenario_file.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;
using overfly::testing::write_text;
using ::testing::HasSubstr;

class ScenarioCalibration : public ::testing::Test {
 protected:
  void SetUp() override { write_calibration("camera.json", 640, 480); }

  void write_calibration(const std::string& name, int width_px, int height_px) {
    const Json camera = {
        {"format", "overfly-calibration"},
        {"format_version", 1},
        {"width_px", width_px},
        {"height_px", height_px},
        {"fx_px", 452.5},
        {"fy_px", 450.25},
        {"cx_px", 326.0},
        {"cy_px", 233.0},
        {"rms_px", 0.1},
        {"distortion", {{"model", "radtan"}, {"coefficients", {-0.2, 0.05, 0.001, 0.0, 0.0}}}}};
    write_text(folder_.path() / name, camera.dump());
  }

  [[nodiscard]] Result<Scenario> resolved(const Json& fields,
                                          const SourcePolicy& sources = {}) const {
    Json document = {{"format_version", 1},
                     {"world", {{"builtin", Json::object()}}},
                     {"flight", {{"course", Json::object()}}}};
    document.update(fields);
    return resolve_scenario(document, {}, folder_.path(), sources);
  }

  [[nodiscard]] std::string error_of(const Json& fields, const SourcePolicy& sources = {}) const {
    const Result<Scenario> read = resolved(fields, sources);
    return read ? "none" : read.error().message;
  }

  overfly::testing::TemporaryFolder folder_;
};

TEST_F(ScenarioCalibration, GivesSizeIntrinsicsAndDistortion) {
  const auto read = resolved({{"camera", {{"calibration", "camera.json"}, {"rate_hz", 20}}}});
  ASSERT_TRUE(read.ok()) << read.error().message;
  const CameraModel& model = read->main_camera().model;
  EXPECT_EQ(model.pinhole().width_px, 640);
  EXPECT_EQ(model.pinhole().height_px, 480);
  EXPECT_EQ(model.pinhole().fx_px, 452.5);
  EXPECT_EQ(model.pinhole().cy_px, 233.0);
  EXPECT_EQ(model.distortion().model, DistortionModel::kRadtan);
  EXPECT_EQ(model.distortion().k[0], -0.2);
  EXPECT_EQ(read->rate.hz(), 20.0);
}

TEST_F(ScenarioCalibration, AppliesToOneOfSeveralCameras) {
  const auto read = resolved(
      {{"cameras",
        {{{"name", "a"}, {"fov_deg", 60}}, {{"name", "b"}, {"calibration", "camera.json"}}}}});
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->cameras[0].model.pinhole().width_px, 1280);
  EXPECT_EQ(read->cameras[1].model.pinhole().width_px, 640);
}

/// A run folder's scenario.json must not need the file.
TEST_F(ScenarioCalibration, IsReplacedByItsFields) {
  const auto read = resolved({{"camera", {{"calibration", "camera.json"}}}});
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_FALSE(read->resolved.at("camera").contains("calibration"));
  std::filesystem::remove(folder_.path() / "camera.json");
  const auto again = resolve_scenario(read->resolved, {}, folder_.path());
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(again->main_camera().model.pinhole().fx_px, 452.5);
  EXPECT_EQ(again->main_camera().model.distortion().k[0], -0.2);
}

TEST_F(ScenarioCalibration, ExcludesFieldsThatTheFileDetermines) {
  const std::vector<std::pair<std::string, Json>> fields = {
      {"width_px", 640}, {"height_px", 480}, {"fov_deg", 60}, {"fov_axis", "vertical"}};
  for (const auto& [field, value] : fields) {
    EXPECT_THAT(error_of({{"camera", {{"calibration", "camera.json"}, {field, value}}}}),
                HasSubstr("camera." + field));
  }
  EXPECT_THAT(
      error_of({{"camera", {{"calibration", "camera.json"}, {"fx_px", 400}, {"fy_px", 400}}}}),
      HasSubstr("camera.fx_px = 400: must not be given with camera.calibration"));
}

TEST_F(ScenarioCalibration, NamesFieldAndFileOfErrors) {
  EXPECT_THAT(error_of({{"camera", {{"calibration", "absent.json"}}}}),
              ::testing::AllOf(HasSubstr("camera.calibration"), HasSubstr("absent.json")));
  write_text(folder_.path() / "other.json", "{}");
  EXPECT_THAT(error_of({{"cameras", {{{"calibration", "other.json"}}}}}),
              ::testing::AllOf(HasSubstr("cameras.0.calibration"), HasSubstr("other.json")));
}

TEST_F(ScenarioCalibration, MustMeetTheLimitsOfACameraInTheDocument) {
  write_calibration("large.json", 9000, 480);
  EXPECT_THAT(error_of({{"camera", {{"calibration", "large.json"}}}}),
              HasSubstr("camera.width_px = 9000"));
}

/// A server's clients must not learn which other files exist.
TEST_F(ScenarioCalibration, IsOpenedOnlyInsideTheDataFolders) {
  const auto confined = SourcePolicy::inside({folder_.path() / "data"});
  std::filesystem::create_directory(folder_.path() / "data");
  const std::string existing = error_of({{"camera", {{"calibration", "camera.json"}}}}, confined);
  std::string absent = error_of({{"camera", {{"calibration", "absent.json"}}}}, confined);
  EXPECT_THAT(existing, HasSubstr("camera.calibration"));
  absent.replace(absent.find("absent"), 6, "camera");
  EXPECT_EQ(existing, absent);
  write_calibration("data/camera.json", 640, 480);
  EXPECT_EQ(error_of({{"camera", {{"calibration", "data/camera.json"}}}}, confined), "none");
}

}  // namespace
}  // namespace overfly::server
