// Map points in playback: those recorded last are in the scene, placed by the alignment.
#include <gtest/gtest.h>

#include <future>
#include <utility>

#include "renderer/renderer.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/map_points.hpp"
#include "server/record/run_folder.hpp"
#include "server/views/view_service.hpp"
#include "tests/server/support/manager_fixture.hpp"

namespace overfly::server {
namespace {

/// Draws nothing and keeps the points of the last scene.
class PointsWitness final : public renderer::Renderer {
 public:
  PointsWitness(std::unique_ptr<renderer::Renderer> inner, std::vector<Eigen::Vector3f>& points)
      : inner_(std::move(inner)), points_(points) {}
  Result<renderer::CameraFrame> render_camera(const renderer::CameraRequest& request) override {
    return inner_->render_camera(request);
  }
  Result<DepthImage> render_depth(const renderer::CameraRequest& request) override {
    return inner_->render_depth(request);
  }
  Result<Image> render_scene(const renderer::SceneView& view,
                             const renderer::SceneContent& content) override {
    points_ = content.points;
    return inner_->render_scene(view, content);
  }
  [[nodiscard]] renderer::RendererInfo info() const override { return inner_->info(); }

 private:
  std::unique_ptr<renderer::Renderer> inner_;
  std::vector<Eigen::Vector3f>& points_;
};

class ViewMapPointsTest : public testing::ManagerTest {
 protected:
  std::vector<Eigen::Vector3f> points_at_frame(RunManager& runs,
                                               const std::string& id,
                                               std::int64_t frame) {
    std::promise<Result<Picture>> answer;
    ViewService views(runs);
    PictureRequest request;
    request.run_id = id;
    request.kind = PictureRequest::Kind::kScene;
    request.t_ns = frame * 100'000'000;
    points.clear();
    views.request(1, 1, request, [&](Result<Picture> picture) { answer.set_value(picture); });
    const Result<Picture> picture = answer.get_future().get();
    EXPECT_TRUE(picture.ok()) << picture.error().message;
    return points;
  }

  std::vector<Eigen::Vector3f> points;  ///< of the last scene, written before its answer
};

TEST_F(ViewMapPointsTest, AreThoseRecordedLast) {
  RunManagerOptions watched = options();
  watched.renderer_factory = [this](std::shared_ptr<const terrain::TileSource> tiles)
      -> Result<std::unique_ptr<renderer::Renderer>> {
    std::unique_ptr<renderer::Renderer> witness =
        std::make_unique<PointsWitness>(renderer::create_noop_renderer(std::move(tiles)), points);
    return witness;
  };
  const auto runs = std::move(RunManager::create(watched).value());
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

}  // namespace
}  // namespace overfly::server
