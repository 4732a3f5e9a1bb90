// What a scene contains: map points recorded last, and the tracks of other runs.
#include <gtest/gtest.h>

#include <future>
#include <utility>
#include <vector>

#include "renderer/viewpoint.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/map_points.hpp"
#include "server/record/run_folder.hpp"
#include "server/views/view_ribbons.hpp"
#include "server/views/view_scene.hpp"
#include "server/views/view_service.hpp"
#include "tests/server/support/manager_fixture.hpp"
#include "tests/server/support/wrapped_renderer.hpp"

namespace overfly::server {
namespace {

/// Draws nothing and keeps the contents of the last scene and the scenes that may follow.
class SceneWitness final : public testing::WrappedRenderer {
 public:
  SceneWitness(std::unique_ptr<renderer::Renderer> inner,
               renderer::SceneContent& content,
               std::vector<std::vector<renderer::SceneView>>& expected)
      : WrappedRenderer(std::move(inner)), content_(content), expected_(expected) {}
  Result<Image> render_scene(const renderer::SceneView& view,
                             const renderer::SceneContent& content) override {
    content_ = content;
    return inner().render_scene(view, content);
  }
  void expect_scenes(const std::vector<renderer::SceneView>& views) override {
    expected_.push_back(views);
  }

 private:
  renderer::SceneContent& content_;
  std::vector<std::vector<renderer::SceneView>>& expected_;
};

class ViewSceneContentTest : public testing::ManagerTest {
 protected:
  std::unique_ptr<RunManager> watched_runs() {
    RunManagerOptions watched = options();
    watched.renderer_factory = [this](std::shared_ptr<const terrain::TileSource> tiles)
        -> Result<std::unique_ptr<renderer::Renderer>> {
      std::unique_ptr<renderer::Renderer> witness = std::make_unique<SceneWitness>(
          renderer::create_noop_renderer(std::move(tiles)), content, expected);
      return witness;
    };
    return std::move(RunManager::create(watched).value());
  }

  const renderer::SceneContent& drawn(RunManager& runs, const PictureRequest& request) {
    std::promise<Result<Picture>> answer;
    ViewService views(runs);
    content = {};
    views.request(1, 1, request, [&](Result<Picture> picture) { answer.set_value(picture); });
    const Result<Picture> picture = answer.get_future().get();
    EXPECT_TRUE(picture.ok()) << picture.error().message;
    return content;
  }

  static std::vector<SceneLabel> labels_of(RunManager& runs, const PictureRequest& request) {
    std::promise<Result<Picture>> answer;
    ViewService views(runs);
    views.request(1, 1, request, [&](Result<Picture> picture) { answer.set_value(picture); });
    return answer.get_future().get().value().labels;
  }

  static std::vector<Override> drifting() {
    return {
        {"estimators",
         nlohmann::json::parse(R"([{"name":"d","type":"drifting","parameters":{"drift":0.2}}])")}};
  }

  static std::string fly_drifting(RunManager& runs) {
    const std::string id = runs.start("small", drifting()).value().id;
    wait_for_end(runs, id);
    return id;
  }

  static PictureRequest scene_of(const std::string& id, std::int64_t frame) {
    PictureRequest request;
    request.run_id = id;
    request.kind = PictureRequest::Kind::kScene;
    request.t_ns = frame * 100'000'000;
    return request;
  }

  std::vector<Eigen::Vector3f> points_at_frame(RunManager& runs,
                                               const std::string& id,
                                               std::int64_t frame) {
    return drawn(runs, scene_of(id, frame)).points;
  }

  renderer::SceneContent content;  ///< of the last scene, written before its answer
  std::vector<std::vector<renderer::SceneView>> expected;  ///< by call; likewise
};

TEST_F(ViewSceneContentTest, HasTheTracksOfOtherRunsAtTheirOwnTimes) {
  const auto runs = watched_runs();
  const std::string id = fly(*runs);
  const std::string other = fly(*runs);
  const renderer::SceneContent alone = drawn(*runs, scene_of(id, 9));
  PictureRequest both = scene_of(id, 9);
  both.others = {{other, 400'000'000, false, "init_scale", {3}}, {"absent", 0, false, "sim3", {9}}};
  const renderer::SceneContent shared = drawn(*runs, both);
  ASSERT_EQ(alone.aircraft.size(), 2U);
  ASSERT_EQ(shared.aircraft.size(), 4U);
  EXPECT_EQ(shared.aircraft[1].rgb, estimator_rgb(0));
  EXPECT_EQ(shared.aircraft[3].rgb, estimator_rgb(3));
  // The same flight, half a second earlier.
  const renderer::SceneContent earlier = drawn(*runs, scene_of(id, 4));
  EXPECT_LT(
      (shared.aircraft[2].T_world_body.translation - earlier.aircraft[0].T_world_body.translation)
          .norm(),
      1e-6);
  EXPECT_GT(
      (shared.aircraft[2].T_world_body.translation - shared.aircraft[0].T_world_body.translation)
          .norm(),
      1.0);
  EXPECT_EQ(shared.ribbons.size(), 2 * alone.ribbons.size());
  EXPECT_EQ(shared.points.size(), alone.points.size()) << "of the main run only";
}

/// As `playback` has them at the same time: the read-outs and the view agree.
TEST_F(ViewSceneContentTest, HasOtherRunsBetweenTheirFrames) {
  const auto runs = watched_runs();
  const std::string id = fly_drifting(*runs);
  const std::string other = fly_drifting(*runs);
  PictureRequest request = scene_of(id, 9);
  const auto at = [&](std::int64_t t_ns) {
    request.others = {{other, t_ns, false, "init_scale", {}}};
    const auto& aircraft = drawn(*runs, request).aircraft;
    EXPECT_EQ(aircraft.size(), 4U);
    return std::pair(aircraft.at(2).T_world_body, aircraft.at(3).T_world_body);
  };
  const auto [truth_before, estimate_before] = at(400'000'000);
  const auto [truth_after, estimate_after] = at(500'000'000);
  const auto [truth, estimate] = at(425'000'000);
  const Pose expected = interpolate(truth_before, truth_after, 0.25);
  EXPECT_LT((truth.translation - expected.translation).norm(), 1e-6);
  EXPECT_LT(truth.rotation.angularDistance(expected.rotation), 1e-9);
  const Pose expected_estimate = interpolate(estimate_before, estimate_after, 0.25);
  EXPECT_LT((estimate.translation - expected_estimate.translation).norm(), 1e-6);
  EXPECT_GT((estimate.translation - estimate_before.translation).norm(), 0.1);
}

/// Dashes along the track under the second alignment, in the colour of the estimate.
TEST_F(ViewSceneContentTest, HasASecondAlignmentAsDashes) {
  const auto runs = watched_runs();
  const std::string id = fly_drifting(*runs);
  PictureRequest request = scene_of(id, 1000);
  const std::size_t alone = drawn(*runs, request).ribbons.size();
  ASSERT_EQ(alone, 2U);
  request.compared = "sim3";
  const auto ribbons = drawn(*runs, request).ribbons;
  ASSERT_GT(ribbons.size(), alone);
  request.compared.clear();
  request.alignment = "sim3";
  const renderer::Ribbon whole = drawn(*runs, request).ribbons.at(1);
  for (std::size_t i = alone; i < ribbons.size(); ++i) {
    const auto& dash = ribbons[i].T_world_body;
    EXPECT_EQ(ribbons[i].rgb, estimator_rgb(0));
    EXPECT_EQ(ribbons[i].wing_span_m, whole.wing_span_m);
    ASSERT_EQ(dash.size(), std::min<std::size_t>(11, whole.T_world_body.size() - 15 * (i - alone)));
    EXPECT_LT(
        (dash.front().translation - whole.T_world_body.at(15 * (i - alone)).translation).norm(),
        1e-9);
  }
  request.alignment = "init_scale";
  request.compared = "unknown";
  EXPECT_EQ(drawn(*runs, request).ribbons.size(), alone);
}

TEST_F(ViewSceneContentTest, LeavesOutHiddenTracksAndTakesTheirColours) {
  const auto runs = watched_runs();
  const std::string id = fly(*runs);
  const std::string other = fly(*runs);
  constexpr TrackRgb kGrey{0.5F, 0.5F, 0.5F};
  PictureRequest request = scene_of(id, 9);
  request.scene.show.errors = true;
  request.scene.show.error_history = true;
  const renderer::SceneContent all = drawn(*runs, request);
  ASSERT_EQ(all.aircraft.size(), 2U);
  ASSERT_FALSE(all.lines.empty());
  ASSERT_FALSE(all.points.empty());
  request.look.colours = {{"", kGrey}, {"p", kTruthRgb}};
  const renderer::SceneContent coloured = drawn(*runs, request);
  EXPECT_EQ(coloured.aircraft.at(0).rgb, kGrey);
  EXPECT_EQ(coloured.aircraft.at(1).rgb, kTruthRgb);
  EXPECT_EQ(coloured.ribbons.at(0).rgb, kGrey);
  EXPECT_EQ(coloured.ribbons.at(1).rgb, kTruthRgb);
  for (const auto& line : coloured.lines) EXPECT_EQ(line.rgb, kTruthRgb);
  request.look.hidden = {"p"};
  const renderer::SceneContent truth = drawn(*runs, request);
  ASSERT_EQ(truth.aircraft.size(), 1U);
  EXPECT_EQ(truth.aircraft[0].rgb, kGrey);
  EXPECT_EQ(truth.ribbons.size(), 1U);
  EXPECT_TRUE(truth.lines.empty());
  EXPECT_TRUE(truth.points.empty());
  request.look.hidden = {"", "unknown"};
  request.others = {{other, 400'000'000, false, "init_scale", {3, {"p"}}}};
  const renderer::SceneContent rest = drawn(*runs, request);
  ASSERT_EQ(rest.aircraft.size(), 2U);
  EXPECT_EQ(rest.aircraft[0].rgb, kTruthRgb) << "the estimate in its own colour";
  EXPECT_EQ(rest.aircraft[1].rgb, kTruthRgb) << "the other run's truth";
  EXPECT_EQ(rest.ribbons.size(), 2U);
}

TEST_F(ViewSceneContentTest, HasTheMapPointsRecordedLast) {
  const auto runs = watched_runs();
  const std::string id = fly(*runs);
  const std::filesystem::path folder = runs->folder(id).value();
  EXPECT_FALSE(points_at_frame(*runs, id, 8).empty()) << "the estimator's own";
  std::filesystem::remove_all(map_points_file(folder, "p", 0).parent_path());
  MapPoints recorded;
  recorded.S_world_vo.scale = 2.0;
  recorded.S_world_vo.translation = {100.0, 0.0, 0.0};
  for (const std::int64_t frame : {5, 9}) {
    recorded.points_vo = {Eigen::Vector3f(static_cast<float>(frame), 1.0F, -3.0F)};
    const std::filesystem::path file = map_points_file(folder, "p", frame);
    std::filesystem::create_directories(file.parent_path());
    ASSERT_TRUE(write_whole(file, bytes_of(recorded)).ok());
  }
  EXPECT_TRUE(points_at_frame(*runs, id, 4).empty());
  using Points = std::vector<Eigen::Vector3f>;
  EXPECT_EQ(points_at_frame(*runs, id, 8), Points{Eigen::Vector3f(110.0F, 2.0F, -6.0F)});
  EXPECT_EQ(points_at_frame(*runs, id, 9), Points{Eigen::Vector3f(118.0F, 2.0F, -6.0F)});
  // A damaged file costs the points, not the picture.
  ASSERT_TRUE(write_whole(map_points_file(folder, "p", 9), std::string("damaged")).ok());
  EXPECT_TRUE(points_at_frame(*runs, id, 12).empty());
}

TEST_F(ViewSceneContentTest, HasTheFrustumOfTheCamerasLens) {
  const auto runs = watched_runs();
  std::vector<Override> bent = perfect();
  bent.push_back({"camera.distortion",
                  nlohmann::json::parse(R"({"model":"radtan","coefficients":[-0.12,0.02,0,0]})")});
  const std::string id = runs->start("small", bent).value().id;
  wait_for_end(*runs, id);
  const renderer::SceneContent scene = drawn(*runs, scene_of(id, 9));
  ASSERT_TRUE(scene.frustum);
  EXPECT_EQ(scene.frustum->camera.distortion().model, DistortionModel::kRadtan);
  EXPECT_TRUE(scene.frustum->camera == runs->timeline(id).value()->main_camera().model);
}

TEST_F(ViewSceneContentTest, HasOnlyThePartsThatAreShown) {
  const auto runs = watched_runs();
  const std::string id = fly_drifting(*runs);
  PictureRequest request = scene_of(id, 15);
  const renderer::SceneContent usual = drawn(*runs, request);
  EXPECT_EQ(usual.aircraft.size(), 2U);
  EXPECT_TRUE(usual.frustum && usual.frustum->edges && usual.frustum->footprint);
  EXPECT_TRUE(usual.lines.empty());
  EXPECT_FALSE(usual.projection);
  request.scene.show = {false, false, false, true, false, true, true, false, false};
  const renderer::SceneContent some = drawn(*runs, request);
  EXPECT_TRUE(some.aircraft.empty() && some.ribbons.empty() && some.points.empty());
  EXPECT_TRUE(some.frustum && !some.frustum->edges && some.frustum->footprint);
  ASSERT_EQ(some.lines.size(), 1U);
  EXPECT_LT((some.lines[0].from_world - usual.aircraft[0].T_world_body.translation).norm(), 1e-9);
  EXPECT_LT((some.lines[0].to_world - usual.aircraft[1].T_world_body.translation).norm(), 1e-9);
  ASSERT_TRUE(some.projection);
  EXPECT_EQ(some.projection->image->width_px, 160);
  EXPECT_EQ(some.projection->camera.pinhole().width_px, 160);
  const Pose T_world_camera = runs->timeline(id).value()->frame_at(request.t_ns)->T_world_camera;
  EXPECT_LT((some.projection->T_world_camera_first.translation - T_world_camera.translation).norm(),
            1e-6);
  request.scene.show = {false, false, false, false, false, false, false, true, false};
  const renderer::SceneContent history = drawn(*runs, request);
  EXPECT_FALSE(history.frustum);
  // Poses of ribbons are every third one, of which the first is at the start.
  EXPECT_EQ(history.lines.size(), 6U);
  for (const auto& line : history.lines) {
    EXPECT_LT((line.to_world - line.from_world).norm(), 20.0);
  }
  EXPECT_GT((history.lines.back().to_world - history.lines.back().from_world).norm(), 0.5);
}

TEST_F(ViewSceneContentTest, TellsWhereTheAircraftAre) {
  const auto runs = watched_runs();
  const std::string id = fly_drifting(*runs);
  PictureRequest request = scene_of(id, 15);
  request.scene.mode = SceneMode::kTop;
  request.scene.distance_m = 300.0;
  EXPECT_TRUE(labels_of(*runs, request).empty()) << "unless they are asked for";
  request.scene.show.labels = true;
  const std::vector<SceneLabel> labels = labels_of(*runs, request);
  ASSERT_EQ(labels.size(), 2U);
  EXPECT_EQ(labels[0].run_id, id);
  EXPECT_EQ(labels[0].estimator, "");
  EXPECT_NEAR(labels[0].x_px, 479.5, 1e-6) << "the aircraft is in the middle";
  EXPECT_NEAR(labels[0].y_px, 359.5, 1e-6);
  EXPECT_EQ(labels[1].estimator, "d");
  EXPECT_GT(labels[1].error_m, 0.5);
  request.scene.mode = SceneMode::kOnboard;
  for (const SceneLabel& label : labels_of(*runs, request)) {
    EXPECT_FALSE(label.estimator.empty()) << "not of the aircraft that one is in";
  }
}

TEST_F(ViewSceneContentTest, PreparesTheScenesOfTheWholeFlightOnce) {
  const auto runs = watched_runs();
  const std::string id = fly(*runs);
  const auto timeline = runs->timeline(id).value();
  ViewService views(*runs);
  const auto draw = [&](const PictureRequest& request) {
    std::promise<Result<Picture>> answer;
    views.request(1, 1, request, [&](Result<Picture> picture) { answer.set_value(picture); });
    ASSERT_TRUE(answer.get_future().get().ok());
  };
  PictureRequest request = scene_of(id, 4);
  request.scene.mode = SceneMode::kOnboard;
  request.scene.width_px = 320;
  draw(request);
  request.scene.azimuth_rad = 1.0;
  draw(request);
  ASSERT_EQ(expected.size(), 1U) << "not again for each change of the view";
  const std::vector<renderer::SceneView>& along = expected.front();
  ASSERT_EQ(along.size(), 256U);
  const std::size_t count = timeline->frame_count();
  const auto at = [&](std::size_t frame) {
    const FrameRow row = timeline->frames(frame, 1).front();
    return renderer::onboard_viewpoint(row.T_world_body, 0.0, 0.4).translation;
  };
  EXPECT_EQ(along[0].width_px, 320);
  EXPECT_LT((along[0].T_world_camera.translation - at(0)).norm(), 1e-9);
  EXPECT_LT((along[1].T_world_camera.translation - at(count / 2)).norm(), 1e-9);
  EXPECT_LT((along[2].T_world_camera.translation - at(count / 4)).norm(), 1e-9);
  EXPECT_LT((along[3].T_world_camera.translation - at(3 * count / 4)).norm(), 1e-9);
  request.scene.mode = SceneMode::kTop;
  request.scene.follow = false;
  EXPECT_TRUE(scene_views_along(*timeline, request.scene).empty()) << "does not move";
}

}  // namespace
}  // namespace overfly::server
