// What OpenGL keeps for the renderer: targets by size, images in flight in their order, tiles as
// textures.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "renderer/egl/egl_context.hpp"
#include "renderer/egl/pixel_ring.hpp"
#include "renderer/egl/target_pool.hpp"
#include "renderer/egl/texture_upload.hpp"
#include "renderer/egl/tile_textures.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer::egl {
namespace {

using terrain::TileId;

class GlResources : public ::testing::Test {
 protected:
  void SetUp() override {
    auto context = EglContext::create();
    if (!context.ok()) GTEST_SKIP() << context.error().message;
    context_ = std::move(*context);
  }
  void TearDown() override {
    if (context_ == nullptr) return;
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  }

  /// Fills a target with one colour and a darker rectangle from (1, 2), 3 x 1 px.
  static void paint(const RenderTarget& target, float grey) {
    target.bind();
    glDisable(GL_SCISSOR_TEST);
    glClearColor(grey, 0.5F * grey, 0.25F * grey, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_SCISSOR_TEST);
    glScissor(1, 2, 3, 1);
    glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
  }
  static bool black(const Image& image, int x, int y) { return image.at(x, y) == 0; }

  std::unique_ptr<EglContext> context_;
};

TEST_F(GlResources, ImagesLeaveTheRingInTheOrderTheyEnteredIt) {
  PixelRing ring(3);
  TargetPool pool;
  EXPECT_TRUE(ring.empty());
  Image image;
  // Widths that are no multiple of four, two sizes, and more images than the ring holds.
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 3; ++i) {
      const int width_px = i == 1 ? 7 : 13;
      const auto target =
          pool.get(width_px, 5, i == 2 ? TargetFormat::kRgba8 : TargetFormat::kGrey8);
      ASSERT_TRUE(target.ok());
      paint(**target, (51.0F * (i + 1) + round) / 255.0F);
      ring.push(**target);
    }
    EXPECT_TRUE(ring.full());
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(ring.pop(image));
      ASSERT_EQ(image.width_px, i == 1 ? 7 : 13);
      ASSERT_EQ(image.height_px, 5);
      ASSERT_EQ(image.channels, i == 2 ? 3 : 1);
      for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < image.width_px; ++x) {
          const bool inside = y == 2 && x >= 1 && x < 4;
          EXPECT_NEAR(image.at(x, y), inside ? 0 : 51 * (i + 1) + round, 1);
          if (i != 2) continue;
          EXPECT_NEAR(image.at(x, y, 2), inside ? 0 : (153 + round) / 4.0, 1.0);
        }
      }
    }
    EXPECT_TRUE(ring.empty());
  }
}

TEST_F(GlResources, ARingMayBeDestroyedWithImagesInIt) {
  TargetPool pool;
  PixelRing ring(2);
  const auto target = pool.get(9, 9, TargetFormat::kGrey8);
  ASSERT_TRUE(target.ok());
  paint(**target, 1.0F);
  ring.push(**target);
}

TEST_F(GlResources, ThePoolReusesTargetsAndForgetsTheOldest) {
  TargetPool pool;
  const auto get = [&](int width_px, TargetFormat format) {
    const auto target = pool.get(width_px, 4, format);
    EXPECT_TRUE(target.ok());
    EXPECT_TRUE((*target)->fits(width_px, 4));
    EXPECT_EQ((*target)->format(), format);
    return *target;
  };
  RenderTarget* first = get(16, TargetFormat::kGrey8);
  paint(*first, 1.0F);
  EXPECT_NE(get(16, TargetFormat::kRgba8), first) << "another format";
  EXPECT_NE(get(17, TargetFormat::kGrey8), first) << "another size";
  EXPECT_EQ(get(16, TargetFormat::kGrey8), first);
  for (int i = 0; i < 7; ++i) (void)get(30 + i, TargetFormat::kGrey8);
  EXPECT_EQ(get(16, TargetFormat::kGrey8), first) << "it was used last but seven";
  Image image;
  first->read(image);
  EXPECT_TRUE(black(image, 1, 2) && !black(image, 0, 2)) << "with what was drawn";
  RenderTarget* used_often = get(30, TargetFormat::kGrey8);
  for (int i = 0; i < 20; ++i) {
    (void)get(50 + i, TargetFormat::kGrey8);
    EXPECT_EQ(get(30, TargetFormat::kGrey8), used_often);
  }
}

TEST_F(GlResources, TargetsTooLargeForTheDriverAreRefused) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
  const auto target = RenderTarget::create(most + 1, 16, TargetFormat::kGrey8, 0);
  ASSERT_FALSE(target.ok());
  EXPECT_EQ(target.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(target.error().message.find(std::to_string(most + 1) + " x 16"), std::string::npos);
  while (glGetError() != GL_NO_ERROR) {
  }
}

class GlTiles : public GlResources {
 protected:
  void SetUp() override {
    GlResources::SetUp();
    overfly::testing::ProceduralGround::Options options;
    options.cols = 5;  // the last column of level 1 is half empty
    options.paint = [](double east_m, double) { return 128.0 + east_m / 16.0; };
    tiles_ = std::make_shared<overfly::testing::ProceduralGround>(options);
    store_ = std::make_shared<TileStore>(tiles_, TileStoreOptions{});
  }
  /// The map position shown at (u, v) of a tile's texture, in texels of level 0.
  static Eigen::Vector2d texel_at(const TileId& id, double u, double v) {
    const double texel = std::exp2(id.level);
    return {texel * (512.0 * id.col + 528.0 * u - 8.0), texel * (512.0 * id.row + 528.0 * v - 8.0)};
  }
  static constexpr PixelFormat kGrey = PixelFormat::kGrey8;

  std::shared_ptr<overfly::testing::ProceduralGround> tiles_;
  std::shared_ptr<TileStore> store_;
};

TEST_F(GlTiles, AreUploadedWithTheirTexels) {
  TileTextures textures(store_, std::size_t{64} << 20U);
  const auto drawn = textures.texture({1, 1, 0}, kGrey, true);
  ASSERT_TRUE(drawn.ok());
  EXPECT_EQ(drawn->scale, 1.0F);
  const auto pixels = store_->get({1, 1, 0}, kGrey).value();
  for (const std::size_t mip : {0U, 3U}) {
    const Image& level = pixels->levels[mip];
    std::vector<std::uint8_t> read(level.data.size());
    glBindTexture(GL_TEXTURE_2D, drawn->texture);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTexImage(GL_TEXTURE_2D, static_cast<GLint>(mip), GL_RED, GL_UNSIGNED_BYTE, read.data());
    EXPECT_EQ(read, level.data);
  }
  EXPECT_EQ(textures.texture({1, 1, 0}, kGrey, true)->texture, drawn->texture);
  EXPECT_EQ(textures.held_bytes(), pixels->bytes());
  EXPECT_EQ(textures.end_view(), 0);
}

TEST_F(GlTiles, LateOnesShowTheirPlaceInACoarserOne) {
  TileTextures textures(store_, std::size_t{64} << 20U);
  ASSERT_TRUE(textures.texture({2, 0, 1}, kGrey, true).ok());
  const TileId late{0, 3, 6};
  const auto drawn = textures.texture(late, kGrey, false);
  ASSERT_TRUE(drawn.ok());
  ASSERT_EQ(drawn->texture, textures.texture({2, 0, 1}, kGrey, true)->texture);
  for (const double u : {0.0, 0.3, 1.0}) {
    for (const double v : {0.0, 0.8, 1.0}) {
      const Eigen::Vector2d shown = texel_at(
          {2, 0, 1}, drawn->scale * u + drawn->offset[0], drawn->scale * v + drawn->offset[1]);
      EXPECT_LT((shown - texel_at(late, u, v)).norm(), 0.01);
    }
  }
  EXPECT_EQ(textures.end_view(), 1);
  store_->wait_until_idle();
  EXPECT_EQ(textures.texture(late, kGrey, false)->scale, 1.0F) << "it has come meanwhile";
  EXPECT_EQ(textures.end_view(), 0);
}

TEST_F(GlTiles, WaitForTheCoarsestIfThereIsNoOther) {
  TileTextures textures(store_, std::size_t{64} << 20U);
  const auto drawn = textures.texture({0, 4, 4}, kGrey, false);
  ASSERT_TRUE(drawn.ok());
  EXPECT_FLOAT_EQ(drawn->scale, 0.125F);
  EXPECT_EQ(drawn->texture, textures.texture({3, 0, 0}, kGrey, false)->texture);
  // Imagery ends with column 4 of 8: at 2560 texels.
  EXPECT_TRUE(textures.has_imagery({0, 4, 4}, kGrey, 0.9, 0.5));
  EXPECT_TRUE(textures.texture({0, 5, 4}, kGrey, false).ok());
  EXPECT_FALSE(textures.has_imagery({0, 5, 4}, kGrey, 0.5, 0.5));
  EXPECT_FALSE(textures.has_imagery({0, 7, 7}, kGrey, 0.5, 0.5)) << "never asked for";
}

TEST_F(GlTiles, TheOldestGoWhenTheViewIsDrawn) {
  const std::size_t bytes = store_->get({0, 0, 0}, kGrey).value()->bytes();
  TileTextures textures(store_, 2 * bytes);
  for (int row = 0; row < 4; ++row) ASSERT_TRUE(textures.texture({0, 0, row}, kGrey, true).ok());
  EXPECT_EQ(textures.held_bytes(), 4 * bytes) << "all of a view are kept";
  (void)textures.texture({0, 0, 1}, kGrey, true);
  (void)textures.end_view();
  EXPECT_EQ(textures.held_bytes(), 2 * bytes);
  EXPECT_TRUE(textures.has_imagery({0, 0, 1}, kGrey, 0.5, 0.5)) << "used last";
  EXPECT_TRUE(textures.has_imagery({0, 0, 3}, kGrey, 0.5, 0.5));
  EXPECT_FALSE(textures.has_imagery({0, 0, 2}, kGrey, 0.5, 0.5)) << "no longer held";
}

TEST_F(GlTiles, TheVoidHasItsColour) {
  TileTextures textures(store_, std::size_t{64} << 20U);
  const GLuint name = textures.void_texture(PixelFormat::kRgb8);
  std::array<std::uint8_t, 4> rgba{};
  glBindTexture(GL_TEXTURE_2D, name);
  glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  EXPECT_EQ(rgba, (std::array<std::uint8_t, 4>{128, 128, 120, 0}));
  EXPECT_EQ(textures.void_texture(PixelFormat::kRgb8), name);
  EXPECT_NE(textures.void_texture(kGrey), name);
}

}  // namespace
}  // namespace overfly::renderer::egl
