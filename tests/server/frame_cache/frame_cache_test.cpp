// The cache of a flight: what it finds, what it says when something is wrong, and what it costs.
#include "server/frame_cache/frame_cache.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "core/measure/sha256.hpp"
#include "server/frame_cache/cached_renderer.hpp"
#include "server/worlds/scenario_world.hpp"
#include "tests/server/support/server_fixture.hpp"
#include "tests/server/support/wrapped_renderer.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using renderer::CameraFrame;
using renderer::CameraRequest;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 30U;

std::string cache_key(int number) {
  const std::string text = std::to_string(number);
  return sha256_hex({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

CameraRequest request_at(int number) {
  PinholeCamera pinhole;
  pinhole.width_px = 64;
  pinhole.height_px = 48;
  pinhole.fx_px = pinhole.fy_px = 60.0;
  Pose T_world_camera;
  T_world_camera.translation = {0.0, 0.0, 100.0 + number};
  return CameraRequest::still(
      CameraModel(pinhole), T_world_camera, number, renderer::PixelFormat::kGrey8);
}

CameraFrame frame_at(int number) {
  const CameraRequest request = request_at(number);
  CameraFrame frame;
  frame.camera = request.camera;
  frame.t_ns = request.t_ns;
  frame.image = Image(64, 48, 1);
  for (std::size_t i = 0; i < frame.image.data.size(); ++i) {
    frame.image.data[i] = static_cast<std::uint8_t>(i * 31 + number);
  }
  return frame;
}

class FrameCacheTest : public ::testing::Test {
 protected:
  std::unique_ptr<FrameCache> open(std::uint64_t budget_bytes = kPlenty,
                                   std::uint64_t least_free_bytes = 0) {
    return std::make_unique<FrameCache>(
        FrameFolderOptions{path(), budget_bytes, 0, least_free_bytes},
        [this](const std::string& text) { warnings_.push_back(text); });
  }
  /// Pictures 0 to count - 1, as a flight that is over leaves them.
  void fill(int count) {
    const auto cache = open();
    for (int i = 0; i < count; ++i) cache->add(cache_key(i), frame_at(i));
    cache->finish();
    ASSERT_EQ(cache->use().added, static_cast<std::uint64_t>(count));
  }
  [[nodiscard]] fs::path path() const { return folder_.path() / "cache"; }
  [[nodiscard]] fs::path file_of(int number) const {
    return FrameFolder({path(), 0, 0, 0}).file_of(cache_key(number));
  }

  overfly::testing::TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

TEST_F(FrameCacheTest, FindsWhatAnotherFlightAdded) {
  fill(3);
  const auto cache = open();
  for (int i = 0; i < 3; ++i) {
    const auto found = cache->find(cache_key(i), request_at(i));
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->image.data, frame_at(i).image.data);
    EXPECT_EQ(found->t_ns, i);
  }
  EXPECT_FALSE(cache->find(cache_key(3), request_at(3)).has_value());
  const FrameCacheUse use = cache->use();
  EXPECT_EQ(use.read, 3U);
  EXPECT_EQ(use.rendered, 1U);
  EXPECT_EQ(json_from(use).dump(),
            R"({"added":0,"damaged":0,"passed_over":0,"read":3,"rendered":1})");
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(FrameCacheTest, DamagedPicturesAreReportedOnceAndReplaced) {
  fill(4);
  std::string bytes = overfly::testing::read_text(file_of(0));
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  overfly::testing::write_text(file_of(0), bytes);
  fs::resize_file(file_of(1), 40);
  overfly::testing::write_text(file_of(2), "");
  const auto cache = open();
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(cache->find(cache_key(i), request_at(i)).has_value());
    cache->add(cache_key(i), frame_at(i));
  }
  EXPECT_TRUE(cache->find(cache_key(3), request_at(3)).has_value());
  cache->finish();
  EXPECT_EQ(cache->use().damaged, 3U);
  EXPECT_EQ(cache->use().added, 3U);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr(file_of(0).string() + ": is damaged")));
  const auto again = open();
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(again->find(cache_key(i), request_at(i)).has_value()) << i;
  }
  EXPECT_EQ(warnings_.size(), 1U);
}

TEST_F(FrameCacheTest, WithoutABudgetItOnlyReads) {
  {
    const auto cache = open(0);
    cache->add(cache_key(1), frame_at(1));
  }
  EXPECT_FALSE(fs::exists(path()));
  fill(1);
  const auto cache = open(0);
  EXPECT_TRUE(cache->find(cache_key(0), request_at(0)).has_value());
  cache->add(cache_key(1), frame_at(1));
  cache->finish();
  EXPECT_FALSE(fs::exists(file_of(1)));
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(FrameCacheTest, AFullDiskEndsTheAddingWithOneMessage) {
  fill(1);
  const auto cache = open(kPlenty, std::uint64_t{1} << 62U);
  for (int i = 1; i < 20; ++i) cache->add(cache_key(i), frame_at(i));
  cache->finish();
  EXPECT_EQ(cache->use().added, 0U);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("MiB are left on its disk")));
  EXPECT_THAT(warnings_.front(), HasSubstr("no more pictures are added"));
  EXPECT_THAT(cache->use().problem, HasSubstr("left on its disk"));
  // What is there is still of use.
  EXPECT_TRUE(cache->find(cache_key(0), request_at(0)).has_value());
}

TEST_F(FrameCacheTest, AFolderThatCannotBeUsedIsReportedOnce) {
  overfly::testing::write_text(path(), "a file");
  const auto cache = open();
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(cache->find(cache_key(i), request_at(i)).has_value());
    cache->add(cache_key(i), frame_at(i));
  }
  cache->finish();
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr(path().string())));
  EXPECT_EQ(cache->use().rendered, 3U);
}

TEST_F(FrameCacheTest, PicturesArePassedOverInsteadOfWaitedFor) {
  CameraFrame large;
  large.image = Image(10'000, 10'000, 1);  // more than may wait
  const auto cache = open();
  cache->add(cache_key(0), large);
  cache->add(cache_key(1), frame_at(1));
  cache->finish();
  EXPECT_EQ(cache->use().passed_over, 1U);
  EXPECT_EQ(cache->use().added, 1U);
}

/// Counts what is really drawn.
class CountedRenderer final : public testing::WrappedRenderer {
 public:
  using Renderer::render_camera;
  CountedRenderer(std::unique_ptr<renderer::Renderer> inner, int& drawn, int late_tiles)
      : WrappedRenderer(std::move(inner)), drawn_(drawn), late_tiles_(late_tiles) {}
  Result<CameraFrame> render_camera(const CameraRequest& request) override {
    ++drawn_;
    Result<CameraFrame> frame = inner().render_camera(request);
    if (frame) frame->late_tiles = late_tiles_;
    return frame;
  }

 private:
  int& drawn_;
  int late_tiles_;
};

class CachedRendererTest : public FrameCacheTest {
 protected:
  std::unique_ptr<CachedRenderer> renderer(FrameCache& cache, int late_tiles = 0) {
    return std::make_unique<CachedRenderer>(
        std::make_unique<CountedRenderer>(plain(), drawn_, late_tiles), "context", cache);
  }
  static std::unique_ptr<renderer::Renderer> plain() {
    static const OpenedWorld world = open_scenario_world(testing::small_scenario()).value();
    return renderer::create_noop_renderer(world.world.tiles);
  }
  int drawn_ = 0;
};

TEST_F(CachedRendererTest, DrawsEachPictureOnce) {
  for (int flight = 0; flight < 3; ++flight) {
    const auto cache = open();
    const auto cached = renderer(*cache);
    for (int i = 0; i < 4; ++i) {
      const auto frame = cached->render_camera(request_at(i));
      ASSERT_TRUE(frame.ok());
      const auto expected = plain()->render_camera(request_at(i));
      EXPECT_EQ(frame->image.data, expected->image.data);
      EXPECT_EQ(frame->T_world_camera.matrix(), expected->T_world_camera.matrix());
    }
  }
  EXPECT_EQ(drawn_, 4);
}

TEST_F(CachedRendererTest, KeepsOnlyCompletePictures) {
  const auto cache = open();
  const auto cached = renderer(*cache, 2);
  CameraRequest request = request_at(1);
  ASSERT_TRUE(cached->render_camera(request).ok());
  request.tile_wait_ns = 0;
  ASSERT_TRUE(cached->render_camera(request).ok());
  cache->finish();
  EXPECT_EQ(cache->use().added, 0U);
  EXPECT_EQ(cache->use().rendered, 1U) << "others are not looked for";
}

TEST_F(CachedRendererTest, PassesErrorsOn) {
  const auto cache = open();
  const auto cached = renderer(*cache);
  CameraRequest request = request_at(1);
  request.exposure_ns = -1;
  EXPECT_FALSE(cached->render_camera(request).ok());
  cache->finish();
  EXPECT_EQ(cache->use().added, 0U);
}

}  // namespace
}  // namespace overfly::server
