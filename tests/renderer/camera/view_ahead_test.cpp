// The tiles that are read ahead of a moving camera, and those that are not.
#include "renderer/camera/view_ahead.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "renderer/ground/ground_selection.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

using terrain::TileId;

/// A flat world of 8 x 8 tiles of 256 m from (-1024, 1024), and a camera at 150 m whose pixels are
/// 0.43 m wide on the ground: it needs tiles of level 0, up to 46 m to the east and west and 34 m
/// to the north and south when widened.
class TilesAhead : public ::testing::Test {
 protected:
  TilesAhead() {
    overfly::testing::ProceduralGround::Options options;
    options.curved = false;
    options.paint = [this](double, double) {
      while (held_back_) std::this_thread::yield();
      return 100.0;
    };
    tiles_ = std::make_shared<overfly::testing::ProceduralGround>(options);
    store_ = std::make_shared<TileStore>(tiles_, TileStoreOptions{});
    patches_ = std::make_shared<GroundPatchStore>(tiles_, kPatchBytes);
    ahead_ = std::make_unique<ViewAhead>(store_, patches_);
  }
  ~TilesAhead() override { held_back_ = false; }

  static CameraRequest flying(const Eigen::Vector2d& from, double east_m_s, std::int64_t t_ns) {
    const PinholeCamera camera{160, 120, 350.0, 350.0, 79.5, 59.5};
    const Pose pose{R_world_body_from({}) * R_body_camera_nadir(), {from.x(), from.y(), 150.0}};
    CameraRequest request = CameraRequest::still(camera, pose, t_ns, PixelFormat::kGrey8);
    request.velocity_world_m_s = {east_m_s, 0.0, 0.0};
    return request;
  }
  static View view_from(const Eigen::Vector2d& from) {
    const CameraRequest request = flying(from, 0.0, 0);
    return View::from(request.camera.pinhole(), request.T_world_camera.at(0));
  }
  /// Memory of the patches that a view needs beyond those that are sampled.
  [[nodiscard]] std::size_t missing_bytes(const View& view) const {
    const std::size_t before = patches_->held_bytes();
    GroundPatches patches(patches_);
    (void)select_ground(patches, view, {}, [](const GroundPatch&) {});
    return patches_->held_bytes() - before;
  }
  void wait() {
    ahead_->wait_until_idle();
    store_->wait_until_idle();
  }
  [[nodiscard]] bool held(const TileId& id) const {
    return store_->peek(id, PixelFormat::kGrey8) != nullptr;
  }

  std::atomic<bool> held_back_{false};
  std::shared_ptr<overfly::testing::ProceduralGround> tiles_;
  std::shared_ptr<TileStore> store_;
  static constexpr std::size_t kPatchBytes = std::size_t{2} << 20U;
  std::shared_ptr<GroundPatchStore> patches_;
  std::unique_ptr<ViewAhead> ahead_;
};

TEST_F(TilesAhead, AreThoseOfTheNextThreeSecondsAndOneLevelAbove) {
  // From 600 m west of the middle to 300 m west of it, after 3 s.
  ahead_->expect(flying({-600.0, -100.0}, 100.0, 0));
  wait();
  for (const int col : {1, 2, 3}) EXPECT_TRUE(held({0, col, 4})) << col;
  EXPECT_TRUE(held({1, 0, 2}) && held({1, 1, 2}));
  EXPECT_FALSE(held({0, 0, 4})) << "behind";
  EXPECT_FALSE(held({0, 4, 4})) << "more than 3 s away";
  EXPECT_FALSE(held({0, 2, 3})) << "aside";
  EXPECT_FALSE(held({2, 0, 1})) << "coarser than anything in view";
  EXPECT_GE(ahead_->cpu_s(), 0.0);
}

TEST_F(TilesAhead, AreNotReadForACameraAtRest) {
  ahead_->expect(flying({-600.0, -100.0}, 0.0, 0));
  wait();
  EXPECT_EQ(tiles_->tiles_read(), 0);
}

TEST_F(TilesAhead, AreLookedForAtIntervals) {
  ahead_->expect(flying({-600.0, -100.0}, 1.0, 0));
  wait();
  const int first = tiles_->tiles_read();
  EXPECT_GT(first, 0);
  ahead_->expect(flying({600.0, -100.0}, 1.0, 370'000'000));
  wait();
  EXPECT_EQ(tiles_->tiles_read(), first) << "too soon";
  ahead_->expect(flying({600.0, -100.0}, 1.0, 380'000'000));
  wait();
  EXPECT_GT(tiles_->tiles_read(), first);
  // A jump back in time is a new flight.
  const int second = tiles_->tiles_read();
  ahead_->expect(flying({0.0, -700.0}, 1.0, 0));
  wait();
  EXPECT_GT(tiles_->tiles_read(), second);
}

TEST_F(TilesAhead, AreReadForAllCamerasOfOneTime) {
  // The store reads nothing until both cameras are known, one after the other.
  held_back_ = true;
  ahead_->expect(flying({-600.0, -100.0}, 1.0, 0));
  ahead_->wait_until_idle();
  ahead_->expect(flying({600.0, -100.0}, 1.0, 0));
  ahead_->wait_until_idle();
  held_back_ = false;
  wait();
  EXPECT_TRUE(held({0, 1, 4}) && held({1, 0, 2})) << "the first camera's";
  EXPECT_TRUE(held({0, 6, 4}) && held({1, 3, 2})) << "the second camera's";
}

TEST_F(TilesAhead, GroundOfViewsThatMayFollowIsSampledAndNoTileRead) {
  const View first = view_from({-600.0, -100.0});
  const View second = view_from({600.0, -100.0});
  ahead_->expect_later({first, second});
  wait();
  EXPECT_EQ(missing_bytes(first), 0U);
  EXPECT_EQ(missing_bytes(second), 0U);
  EXPECT_GT(missing_bytes(view_from({0.0, 700.0})), 0U) << "of another view";
  EXPECT_EQ(tiles_->tiles_read(), 0);
}

TEST_F(TilesAhead, GroundOfViewsThatMayFollowLeavesRoomForOthers) {
  std::vector<View> views;
  for (double east_m = -900.0; east_m < 900.0; east_m += 30.0) {
    for (double north_m = -900.0; north_m < 900.0; north_m += 30.0) {
      views.push_back(view_from({east_m, north_m}));
    }
  }
  ahead_->expect_later(views);
  wait();
  EXPECT_FALSE(patches_->has_room());
  EXPECT_LT(patches_->held_bytes(), kPatchBytes) << "nothing was evicted";
  EXPECT_GT(missing_bytes(views.back()), 0U) << "sampled although there was no room";
}

}  // namespace
}  // namespace overfly::renderer
