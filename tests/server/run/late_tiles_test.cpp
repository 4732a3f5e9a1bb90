// Late tiles: none in lockstep; counted and reported in real time.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "server/record/rows/rows.hpp"
#include "server/run/run_options.hpp"
#include "server/timeline/run_timeline.hpp"
#include "tests/server/support/jumping_clock.hpp"
#include "tests/server/support/server_fixture.hpp"
#include "tests/server/support/wrapped_renderer.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

/// Two tiles are late in every image that does not wait for them, except within a metre of an image
/// that did.
class Paging final : public testing::WrappedRenderer {
 public:
  using Renderer::render_camera;
  using WrappedRenderer::WrappedRenderer;
  Result<renderer::CameraFrame> render_camera(const renderer::CameraRequest& request) override {
    auto frame = inner().render_camera(request);
    const Eigen::Vector3d place_m = request.T_world_camera.at(request.t_ns).translation;
    if (request.tile_wait_ns > 0) fetched_m_.push_back(place_m);
    const bool there =
        std::any_of(fetched_m_.begin(), fetched_m_.end(), [&](const Eigen::Vector3d& fetched_m) {
          return (fetched_m - place_m).norm() < 1.0;
        });
    if (frame && !there) frame->late_tiles = 2;
    return frame;
  }

 private:
  std::vector<Eigen::Vector3d> fetched_m_;
};

RunResult flown(const std::string& pacing, const std::filesystem::path& folder) {
  testing::JumpingClock clock;
  RunOptions options;
  options.folder = folder;
  options.clock = &clock;
  options.renderer_factory = [](std::shared_ptr<const terrain::TileSource> tiles) {
    return Result<std::unique_ptr<renderer::Renderer>>(
        std::make_unique<Paging>(renderer::create_noop_renderer(std::move(tiles))));
  };
  auto run = run_scenario(testing::small_scenario({"pacing=" + pacing, "duration_s=1"}), options);
  if (!run) throw std::runtime_error(run.error().message);
  return std::move(*run);
}

TEST(LateTiles, AreCountedInRealTimeAfterTheFirstView) {
  const overfly::testing::TemporaryFolder folder;
  const RunResult run = flown("real_time", folder.path() / "r");
  EXPECT_EQ(run.metrics.cameras.at(kMainCamera).late_tiles, 20);
  EXPECT_EQ(run.metrics.cameras.at(kMainCamera).frames_with_late_tiles, 10);
  const auto opened = RunTimeline::open(folder.path() / "r");
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  for (const FrameRow& row : (*opened)->frames(0, 100)) {
    EXPECT_EQ(row.late_tiles, row.frame == 0 ? 0 : 2);
  }
}

TEST(LateTiles, AreWaitedForInLockstep) {
  const overfly::testing::TemporaryFolder folder;
  const RunResult run = flown("lockstep", folder.path() / "r");
  EXPECT_EQ(run.metrics.cameras.at(kMainCamera).frames, 11);
  EXPECT_EQ(run.metrics.cameras.at(kMainCamera).late_tiles, 0);
}

}  // namespace
}  // namespace overfly::server
