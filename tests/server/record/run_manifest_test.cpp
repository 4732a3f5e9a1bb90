#include "server/record/run_manifest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "server/record/run_folder.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// A manifest in which no two fields have the same value.
RunManifest full_manifest() {
  RunManifest manifest;
  manifest.status = RunStatus::kFailed;
  manifest.error = "out of fuel";
  manifest.scenario = "course";
  manifest.title = "The course";
  manifest.version = "1.2";
  manifest.commit = "0123abc";
  manifest.seed = 0xFEDC'BA98'7654'3210U;
  manifest.pacing = "real_time";
  manifest.epoch_utc_ns = 1'767'225'600'000'000'001;
  manifest.duration_ns = 25'000'000'000;
  manifest.frames = 7;
  manifest.frames_total = 776;
  manifest.texture_limited = true;
  manifest.renderer = RunManifest::Renderer{"egl", "llvmpipe", "4.5", true, "no GPU", "as asked"};
  manifest.flight = RunManifest::Flight{"a course", {"it is steep"}, 1'700'000'000'000'000'001};
  RunManifest::World& world = manifest.world.emplace();
  world.name = "strip";
  world.attribution = "those who took it";
  world.warnings = {"it has holes"};
  world.data_hashes = {{"a.tif", "sha256:1"}, {"b.tif", "sha256:2"}};
  world.origin = geodetic_from_deg(47.25, 8.5, 431.0);
  world.manifest = RunManifest::WorldFile{"world.json", "sha256:3"};
  world.light = "noon";
  world.detail = "grass";
  RunManifest::Camera camera;
  camera.name = "main";
  camera.model =
      CameraModel(PinholeCamera{640, 480, 320.5, 321.5, 319.5, 239.5},
                  Distortion{DistortionModel::kRadtan, {-0.25, 0.125, 0.5, 0.0625, 1.0}});
  camera.rate_hz = 31.0;
  camera.T_body_camera.translation = {0.5, 0.25, -0.125};
  manifest.cameras = {camera, camera};
  manifest.cameras[1].name = "tilted";
  manifest.cameras[1].rgb = true;
  manifest.cameras[1].bits = 12;
  manifest.cameras[1].sensor = RunManifest::Sensor{1000, 0.5, 14};
  RunManifest::Estimator estimator;
  estimator.name = "f";
  estimator.type = "feature";
  estimator.camera = "tilted";
  estimator.parameters = RunManifest::Parameters{{"levels", "4"}};
  estimator.parameters_at_end = RunManifest::Parameters{{"levels", "5"}};
  manifest.estimators = {estimator, {}};
  manifest.estimators[1].name = "p";
  manifest.estimators[1].type = "perfect";
  manifest.estimators[1].test_estimator = true;
  manifest.estimators[1].start_error = "no truth";
  return manifest;
}

class RunManifestFile : public ::testing::Test {
 protected:
  Result<ReadManifest> read(const Json& document) const {
    overfly::testing::write_text(manifest_file(folder_.path()), document.dump());
    return read_run_manifest(folder_.path());
  }
  /// The manifest with one change.
  Result<ReadManifest> read_changed(const std::function<void(Json&)>& change) const {
    Json document = json_from(full_manifest());
    change(document);
    return read(document);
  }

 private:
  overfly::testing::TemporaryFolder folder_;
};

TEST_F(RunManifestFile, IsReadAsItWasWritten) {
  const Json document = json_from(full_manifest());
  const auto full = read(document);
  ASSERT_TRUE(full.ok());
  EXPECT_EQ(full->problem(), "");
  EXPECT_EQ(json_from(full->values), document);
  EXPECT_EQ(document.at("camera").at("rate_hz"), 31.0);
  EXPECT_FALSE(document.at("camera").contains("distortion"));

  const Json empty = json_from(RunManifest());
  EXPECT_EQ(empty.at("world"), Json::object());
  EXPECT_EQ(empty.at("error"), nullptr);
  EXPECT_FALSE(empty.contains("cameras"));
  const auto begun = read(empty);
  ASSERT_TRUE(begun.ok());
  EXPECT_EQ(begun->problem(), "");
  EXPECT_EQ(json_from(begun->values), empty);
}

TEST_F(RunManifestFile, UnknownFieldsAreIgnored) {
  const auto manifest = read_changed([](Json& document) {
    document["weather"] = {{"wind_m_s", 3}};
    document["world"]["geoid"] = 1;
    document["cameras"][0]["lens"] = "glass";
    document["estimators"][0]["author"] = nullptr;
  });
  ASSERT_TRUE(manifest.ok());
  EXPECT_EQ(manifest->problem(), "");
  EXPECT_EQ(json_from(manifest->values), json_from(full_manifest()));
}

TEST_F(RunManifestFile, InvalidFieldIsNamedAndTheOthersAreRead) {
  const auto manifest =
      read_changed([](Json& document) { document["cameras"][1]["T_body_camera"]["p_m"] = 3; });
  ASSERT_TRUE(manifest.ok());
  EXPECT_THAT(manifest->problem(), HasSubstr("manifest.json: cameras.1.T_body_camera = "));
  EXPECT_EQ(manifest->check(ManifestPart::kCameras).error().code, ErrorCode::kUnreadable);
  EXPECT_EQ(manifest->check(ManifestPart::kCameras).error().message, manifest->problem());
  EXPECT_TRUE(manifest->check(ManifestPart::kHead).ok());
  EXPECT_TRUE(manifest->check(ManifestPart::kEstimators).ok());
  EXPECT_TRUE(manifest->check(ManifestPart::kWorld).ok());
  EXPECT_EQ(manifest->values.cameras.size(), 1U);
  EXPECT_EQ(manifest->values.world->attribution, "those who took it");
}

TEST_F(RunManifestFile, OfAnEarlierVersionHasOneCamera) {
  const auto manifest = read_changed([](Json& document) { document.erase("cameras"); });
  ASSERT_TRUE(manifest.ok());
  EXPECT_EQ(manifest->problem(), "");
  ASSERT_EQ(manifest->values.cameras.size(), 1U);
  const RunManifest::Camera& camera = manifest->values.cameras.front();
  EXPECT_EQ(camera.model.pinhole().fx_px, 320.5);
  EXPECT_EQ(camera.T_body_camera.translation.x(), 0.5);
}

TEST_F(RunManifestFile, GivesAndTakesTheInfoOfTheRun) {
  const RunInfo info = run_info_from(full_manifest());
  EXPECT_THAT(info.cameras, ElementsAre("main", "tilted"));
  EXPECT_THAT(info.estimators, ElementsAre("f", "p"));
  EXPECT_THAT(info.estimator_cameras, ElementsAre("tilted", ""));
  EXPECT_EQ(info.attribution, "those who took it");
  EXPECT_EQ(info.flight, "a course");
  EXPECT_EQ(info.seed, 0xFEDC'BA98'7654'3210U);
  ASSERT_TRUE(info.origin);
  EXPECT_EQ(info.origin->alt_ellipsoid_m, 431.0);
  RunManifest manifest;
  put_run_info(info, manifest);
  EXPECT_EQ(manifest.status, RunStatus::kFailed);
  EXPECT_EQ(manifest.error, "out of fuel");
  EXPECT_EQ(manifest.frames_total, 776);
  EXPECT_TRUE(manifest.texture_limited);
}

}  // namespace
}  // namespace overfly::server
