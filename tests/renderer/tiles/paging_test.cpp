// Slow disks: in lockstep an image waits for its tiles, in real time it takes coarser ones, says
// so, and is right as soon as they are there.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "renderer/renderer.hpp"
#include "renderer/tiles/tile_store.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

/// Tiles of another source that come late.
class SlowTiles final : public terrain::TileSource {
 public:
  explicit SlowTiles(std::shared_ptr<const terrain::TileSource> tiles) : tiles_(std::move(tiles)) {}

  [[nodiscard]] Result<terrain::Tile> read_tile(
      const terrain::TileId& id, const terrain::Cancelled& /*cancelled*/) const override {
    std::this_thread::sleep_for(std::chrono::milliseconds(15));
    return tiles_->tile(id);
  }
  [[nodiscard]] double ground_up_m(double east_m, double north_m) const override {
    return tiles_->ground_up_m(east_m, north_m);
  }
  [[nodiscard]] const terrain::TileGrid& grid() const override { return tiles_->grid(); }
  [[nodiscard]] terrain::TileCoverage coverage(const terrain::TileId& id) const override {
    return tiles_->coverage(id);
  }
  [[nodiscard]] Eigen::Vector3d world_from_map(double x_map_m, double y_map_m) const override {
    return tiles_->world_from_map(x_map_m, y_map_m);
  }
  [[nodiscard]] Eigen::Vector2d map_from_world(double east_m, double north_m) const override {
    return tiles_->map_from_world(east_m, north_m);
  }
  [[nodiscard]] bool has_imagery(double x_map_m, double y_map_m) const override {
    return tiles_->has_imagery(x_map_m, y_map_m);
  }
  [[nodiscard]] const LocalFrame& frame() const override { return tiles_->frame(); }
  [[nodiscard]] Eigen::Vector2d height_range_m() const override { return tiles_->height_range_m(); }
  [[nodiscard]] std::string attribution() const override { return tiles_->attribution(); }

 private:
  std::shared_ptr<const terrain::TileSource> tiles_;
};

/// Hills with a ground that is cheap to paint.
std::shared_ptr<const terrain::TileSource> cheap_ground() {
  overfly::testing::ProceduralGround::Options options;
  options.height_m = overfly::testing::hills_m;
  options.height_range_m = {-20.0, 20.0};
  options.paint = [](double east_m, double north_m) {
    return 60.0 + std::abs(std::remainder(3.0 * east_m, 100.0)) +
           std::abs(std::remainder(2.0 * north_m + 0.7 * east_m, 140.0));
  };
  return std::make_shared<overfly::testing::ProceduralGround>(std::move(options));
}

double mean_difference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.data.size(); ++i) sum += std::abs(a.data[i] - b.data[i]);
  return sum / static_cast<double>(a.data.size());
}

class Paging : public ::testing::TestWithParam<CameraBackend> {
 protected:
  void SetUp() override {
    if (GetParam() == CameraBackend::kEgl) {
      if (const auto egl = probe_egl(); !egl.ok()) GTEST_SKIP() << egl.error().message;
    }
    tiles_ = std::make_shared<SlowTiles>(cheap_ground());
    store_ = std::make_shared<TileStore>(tiles_, TileStoreOptions{});
    RendererOptions options;
    options.camera_backend = GetParam();
    options.tile_store = store_;
    renderer_ = std::move(create_renderer(tiles_, options).value());
  }

  /// Over the imagery's middle, or a kilometre of flight further.
  static CameraRequest request(double east_m, bool wait) {
    const auto camera =
        PinholeCamera::from_fov(320, 240, rad_from_deg(84.872), FovAxis::kHorizontal);
    CameraRequest request = CameraRequest::still(
        camera.value(),
        {R_world_body_from({0.2, 0.0, 0.5 * kPi}) * R_body_camera_nadir(), {east_m, 30.0, 120.0}},
        0,
        PixelFormat::kGrey8);
    request.tile_wait_ns = wait ? kForAllTiles : 0;
    return request;
  }

  std::shared_ptr<const terrain::TileSource> tiles_;
  std::shared_ptr<TileStore> store_;
  std::unique_ptr<Renderer> renderer_;
};

TEST_P(Paging, RealTimeCountsLateTilesAndIsRightOnceTheyAreThere) {
  const auto early = renderer_->render_camera(request(0.0, false));
  ASSERT_TRUE(early.ok()) << early.error().message;
  EXPECT_GT(early->late_tiles, 0);
  EXPECT_EQ(early->void_fraction, 0.0) << "coarse ground is drawn, not none";
  store_->wait_until_idle();
  const auto settled = renderer_->render_camera(request(0.0, false));
  ASSERT_TRUE(settled.ok()) << settled.error().message;
  EXPECT_EQ(settled->late_tiles, 0);
  const auto waited = renderer_->render_camera(request(0.0, true));
  ASSERT_TRUE(waited.ok()) << waited.error().message;
  EXPECT_EQ(settled->image.data, waited->image.data);
  // The coarse picture shows the same place: about as bright, with less detail.
  EXPECT_NE(early->image.data, waited->image.data);
  EXPECT_LT(mean_difference(early->image, waited->image), 40.0);
}

TEST_P(Paging, LockstepNeverDrawsACoarserTile) {
  const auto cold = renderer_->render_camera(request(100.0, true));
  ASSERT_TRUE(cold.ok()) << cold.error().message;
  EXPECT_EQ(cold->late_tiles, 0);
  RendererOptions options;
  options.camera_backend = GetParam();
  const auto fast = create_renderer(cheap_ground(), options);
  ASSERT_TRUE(fast.ok());
  const auto expected = (*fast)->render_camera(request(100.0, true));
  ASSERT_TRUE(expected.ok());
  EXPECT_EQ(cold->image.data, expected->image.data);
  // A late picture in between leaves no trace.
  const auto late = renderer_->render_camera(request(-400.0, false));
  ASSERT_TRUE(late.ok());
  EXPECT_GT(late->late_tiles, 0);
  const auto next = renderer_->render_camera(request(-400.0, true));
  ASSERT_TRUE(next.ok());
  EXPECT_EQ(next->late_tiles, 0);
  EXPECT_EQ(next->image.data, (*fast)->render_camera(request(-400.0, true))->image.data);
}

TEST_P(Paging, FlyingTowardsTheGroundHasItThereInTime) {
  CameraRequest now = request(-300.0, true);
  now.velocity_world_m_s = {60.0, 0.0, 0.0};
  ASSERT_TRUE(renderer_->render_camera(now).ok());
  // The look ahead is another thread's: wait until it has asked and its tiles have come.
  for (int i = 0; i < 200 && store_->counts().read_ahead < 2; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  store_->wait_until_idle();
  const std::int64_t before = store_->counts().read_on_demand;
  CameraRequest later = request(-300.0 + 120.0, false);
  later.t_ns = 2'000'000'000;
  const auto frame = renderer_->render_camera(later);
  ASSERT_TRUE(frame.ok());
  EXPECT_EQ(frame->late_tiles, 0);
  EXPECT_EQ(store_->counts().read_on_demand, before);
}

TEST_P(Paging, ALimitedWaitDrawsWhatIsThereInTime) {
  CameraRequest hasty = request(0.0, true);
  hasty.tile_wait_ns = 1;
  const auto early = renderer_->render_camera(hasty);
  ASSERT_TRUE(early.ok()) << early.error().message;
  EXPECT_GT(early->late_tiles, 0);
  EXPECT_EQ(early->void_fraction, 0.0);
  store_->wait_until_idle();
  const auto settled = renderer_->render_camera(hasty);
  ASSERT_TRUE(settled.ok()) << settled.error().message;
  EXPECT_EQ(settled->late_tiles, 0) << "what was late was read for the next picture";
  CameraRequest patient = request(300.0, true);
  patient.tile_wait_ns = 60'000'000'000;
  const auto waited = renderer_->render_camera(patient);
  ASSERT_TRUE(waited.ok()) << waited.error().message;
  EXPECT_EQ(waited->late_tiles, 0);
  const auto whole = renderer_->render_camera(request(300.0, true));
  ASSERT_TRUE(whole.ok()) << whole.error().message;
  EXPECT_EQ(waited->image.data, whole->image.data);
}

/// The ray-caster draws none.
class ScenePaging : public Paging {};

TEST_P(ScenePaging, AViewWithoutWaitIsRightOnceItsTilesAreThere) {
  renderer::SceneView view;
  view.width_px = 160;
  view.height_px = 120;
  view.T_world_camera = {R_world_body_from({0.0, 0.0, 0.5 * kPi}) * R_body_camera_nadir(),
                         {0.0, 30.0, 120.0}};
  view.tile_wait_ns = 0;
  const auto early = renderer_->render_scene(view, {});
  ASSERT_TRUE(early.ok()) << early.error().message;
  store_->wait_until_idle();
  const auto settled = renderer_->render_scene(view, {});
  ASSERT_TRUE(settled.ok()) << settled.error().message;
  view.tile_wait_ns = kForAllTiles;
  const auto waited = renderer_->render_scene(view, {});
  ASSERT_TRUE(waited.ok()) << waited.error().message;
  EXPECT_NE(early->data, waited->data);
  EXPECT_EQ(settled->data, waited->data);
  EXPECT_LT(mean_difference(*early, *waited), 40.0);
}

INSTANTIATE_TEST_SUITE_P(Backends,
                         Paging,
                         ::testing::Values(CameraBackend::kEgl, CameraBackend::kRaycast),
                         [](const auto& suite) {
                           return std::string(suite.param == CameraBackend::kEgl ? "egl"
                                                                                 : "raycast");
                         });
INSTANTIATE_TEST_SUITE_P(Backends, ScenePaging, ::testing::Values(CameraBackend::kEgl));

}  // namespace
}  // namespace overfly::renderer
