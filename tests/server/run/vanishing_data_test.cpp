// Files of the world that are damaged, removed or replaced while a run flies over them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "server/record/run_folder.hpp"
#include "server/record/run_info_file.hpp"
#include "server/record/run_records.hpp"
#include "server/run/run_options.hpp"
#include "server/worlds/world_cache.hpp"
#include "tests/server/support/jumping_clock.hpp"
#include "tests/server/support/server_fixture.hpp"
#include "tests/server/support/wrapped_renderer.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;

/// Reads the tile below the camera for every image. An image that does not wait is drawn without
/// it.
class TileReader final : public testing::WrappedRenderer {
 public:
  explicit TileReader(std::shared_ptr<const terrain::TileSource> tiles)
      : WrappedRenderer(renderer::create_noop_renderer(tiles)), tiles_(std::move(tiles)) {}
  using Renderer::render_camera;
  Result<renderer::CameraFrame> render_camera(const renderer::CameraRequest& request) override {
    auto frame = inner().render_camera(request);
    const auto tile = tiles_->tile({0, 0, 0});
    if (!tile && request.tile_wait_ns > 0) return tile.error().in("tile 0/0/0");
    if (!tile && frame) frame->late_tiles = 1;
    return frame;
  }

 private:
  std::shared_ptr<const terrain::TileSource> tiles_;
  std::unique_ptr<renderer::Renderer> inner_;
};

/// Fails with kNotFound from 1 s on.
class Forgetful final : public testing::WrappedRenderer {
 public:
  using Renderer::render_camera;
  using WrappedRenderer::WrappedRenderer;
  Result<renderer::CameraFrame> render_camera(const renderer::CameraRequest& request) override {
    if (request.t_ns >= kNsPerS) return Error{ErrorCode::kNotFound, "dem.tif: no such file"};
    return inner().render_camera(request);
  }

 private:
  std::unique_ptr<renderer::Renderer> inner_;
};

/// Runs over a copy of the small world that a test may damage, in either pacing mode.
class VanishingData : public ::testing::TestWithParam<const char*> {
 protected:
  VanishingData() {
    fs::copy(testing::small_world().parent_path(), world(), fs::copy_options::recursive);
    options_.renderer_factory = [](std::shared_ptr<const terrain::TileSource> tiles) {
      return Result<std::unique_ptr<renderer::Renderer>>(
          std::make_unique<TileReader>(std::move(tiles)));
    };
    options_.worlds = &worlds_;
    options_.clock = &clock_;
  }

  [[nodiscard]] fs::path world() const { return folder_.path() / "world"; }
  [[nodiscard]] fs::path imagery() const { return world() / "imagery.tif"; }
  [[nodiscard]] fs::path elevation() const { return world() / "elevation.tif"; }

  /// A run in its own folder; `meanwhile` is called once, after the fifth frame.
  Result<RunResult> flown(const std::string& name, const std::function<void()>& meanwhile = {}) {
    options_.folder = folder_.path() / name;
    options_.progress = [&, done = false](const RunInfo& info) mutable {
      if (info.frames < 5 || done || !meanwhile) return;
      done = true;
      meanwhile();
    };
    return run_scenario(scenario(), options_);
  }
  [[nodiscard]] Scenario scenario() const {
    return testing::small_scenario({std::string("pacing=") + GetParam(),
                                    "world.manifest=" + (world() / "world.json").string()});
  }

  /// Checks that the run of that name ended as failed and kept its frames.
  void expect_failed(const std::string& name, std::size_t frames, const std::string& why) {
    const auto info = read_run_info(folder_.path() / name);
    ASSERT_TRUE(info.ok()) << info.error().message;
    EXPECT_EQ(info->status, RunStatus::kFailed);
    EXPECT_THAT(info->error, HasSubstr(why));
    const auto records = read_run_records(folder_.path() / name);
    ASSERT_TRUE(records.ok()) << records.error().message;
    EXPECT_EQ(records->main_camera().frames.size(), frames);
  }

  RunOptions options_;

 private:
  TemporaryFolder folder_;
  WorldCache worlds_;
  testing::JumpingClock clock_;
};

TEST_P(VanishingData, AnythingNotFoundInFlightIsAFailure) {
  options_.renderer_factory = [](std::shared_ptr<const terrain::TileSource> tiles) {
    return Result<std::unique_ptr<renderer::Renderer>>(
        std::make_unique<Forgetful>(renderer::create_noop_renderer(std::move(tiles))));
  };
  EXPECT_FALSE(flown("r").ok());
  expect_failed("r", 10, "dem.tif: no such file");
}

TEST_P(VanishingData, ImageryCutShortEndsTheRunAndNotTheNextOne) {
  const std::string whole = overfly::testing::read_text(imagery());
  const auto run = flown("cut", [&] { fs::resize_file(imagery(), 4000); });
  ASSERT_FALSE(run.ok());
  EXPECT_EQ(run.error().code, ErrorCode::kIo);
  expect_failed("cut", 5, imagery().string() + ": was modified while it was in use");
  overfly::testing::write_text(imagery(), whole);
  const auto next = flown("next");
  ASSERT_TRUE(next.ok()) << next.error().message;
  EXPECT_EQ(next->info.frames, 21);
}

TEST_P(VanishingData, FilesTakenAwayOrReplacedAreReadOnAsTheyWereOpened) {
  const auto whole = flown("whole");
  ASSERT_TRUE(whole.ok()) << whole.error().message;
  const auto run = flown("r", [&] {
    fs::remove(elevation());
    fs::rename(imagery(), world() / "old.tif");
    overfly::testing::write_text(imagery(), "no picture");
  });
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_EQ(run->info.frames, 21);
  const auto before = read_run_records(options_.folder.parent_path() / "whole");
  const auto after = read_run_records(options_.folder);
  for (std::size_t i = 0; i < 21; ++i) {
    EXPECT_EQ(after->main_camera().frames[i].image_crc32,
              before->main_camera().frames[i].image_crc32);
  }
}

INSTANTIATE_TEST_SUITE_P(BothPacings,
                         VanishingData,
                         ::testing::Values("lockstep", "real_time"),
                         [](const auto& pacing) { return std::string(pacing.param); });

}  // namespace
}  // namespace overfly::server
