// Blocks of pixels find tiles that hold all their texels.
#include "renderer/raycast/block_places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer::raycast {
namespace {

constexpr int kSidePx = 64;

/// The texel of a block's pixel.
Eigen::Vector2d texel_of(const Block& block, double x, double y) {
  const auto value = [&](const Bilinear4& f) { return f[0] + f[1] * x + f[2] * y + f[3] * x * y; };
  const double w = value(block.inverse_depth);
  return {block.u + value(block.numerator_u) / w, block.v + value(block.numerator_v) / w};
}

/// A block at (x, y) of a plane that is seen at a slant: `step` texels from pixel to pixel at its
/// first pixel, turned and growing with the row.
Block slanted_block(const Eigen::Vector2d& texel, double step, double turn_rad, int x, int y) {
  Block block;
  block.x = static_cast<std::uint16_t>(x);
  block.y = static_cast<std::uint16_t>(y);
  block.columns = block.rows = 16;
  block.kind = Block::Kind::kGround;
  block.u = texel.x();
  block.v = texel.y();
  const double w = 0.004;
  const auto c = static_cast<float>(step * w * std::cos(turn_rad));
  const auto s = static_cast<float>(step * w * std::sin(turn_rad));
  block.numerator_u = {0.0F, c, -s, 0.0F};
  block.numerator_v = {0.0F, s, c, 0.0F};
  block.inverse_depth = {0.004F, 1e-6F, -2e-5F, 0.0F};
  const auto lod = static_cast<float>(std::log2(step));
  block.lod = {lod, 0.001F, 0.01F, 0.0F};
  block.clear = {0.5F, 0.01F, -0.01F, 0.0F};
  return block;
}

class BlockTiles : public ::testing::Test {
 protected:
  /// Places a block and checks that its parts are the same pixels, once, with the same values.
  void place(const Block& block) {
    band_ = {};
    BlockPlaces(ground_, band_).add(block);
    std::vector<int> covered(16 * 16, 0);
    for (const Block& part : band_.blocks) {
      for (int y = 0; y < part.rows; ++y) {
        for (int x = 0; x < part.columns; ++x) {
          const int column = part.x + x - block.x, row = part.y + y - block.y;
          ASSERT_TRUE(column >= 0 && column < block.columns && row >= 0 && row < block.rows);
          ++covered[row * 16 + column];
          const Eigen::Vector2d there = texel_of(part, x, y);
          ASSERT_LT((there - texel_of(block, column, row)).norm(), 1e-2);
          const auto at = [&](const Bilinear4& f, int i, int j) {
            return f[0] + f[1] * i + f[2] * j;
          };
          ASSERT_NEAR(at(part.lod, x, y), at(block.lod, column, row), 1e-5);
          ASSERT_NEAR(at(part.clear, x, y), at(block.clear, column, row), 1e-5);
        }
      }
    }
    EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), 256);
  }

  /// The tile has no larger texels than needed, and all texels that trilinear samples of the
  /// block's pixels read.
  void expect_held(const Block& part) const {
    ASSERT_GE(part.tile, 0);
    const terrain::TileId id = band_.tiles.at(part.tile);
    const double texel = std::ldexp(1.0, id.level), side = 512.0 * texel;
    for (int y = 0; y < part.rows; ++y) {
      for (int x = 0; x < part.columns; ++x) {
        const double lod = part.lod[0] + part.lod[1] * x + part.lod[2] * y;
        if (id.level > 0) {
          ASSERT_GE(lod, id.level);
        }
        if (part.rows == 1 && part.columns == 1) continue;
        // The coarser of the two mip levels that are blended.
        const double reach =
            0.5 * std::ldexp(texel, std::max(0, static_cast<int>(lod) - id.level + 1));
        const Eigen::Vector2d at = texel_of(part, x, y);
        for (const auto& [place, index] : {std::pair{at.x(), id.col}, std::pair{at.y(), id.row}}) {
          ASSERT_GE(place - reach, index * side - 8.0 * texel);
          ASSERT_LE(place + reach, (index + 1) * side + 8.0 * texel);
        }
      }
    }
  }

  overfly::testing::ProceduralGround ground_{{}};  // 4096 x 4096 texels
  Band band_;
};

TEST_F(BlockTiles, HoldAllTexelsThatAreSampled) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::size_t divided = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double step = std::exp2(4.0 * unit(random) - 1.5);
    const Eigen::Vector2d texel(300.0 + 3000.0 * unit(random), 300.0 + 3000.0 * unit(random));
    place(slanted_block(texel, step, 6.3 * unit(random), 0, kSidePx));
    if (HasFatalFailure()) FAIL() << "trial " << trial;
    divided += band_.blocks.size() > 1 ? 1 : 0;
    for (const Block& part : band_.blocks) {
      EXPECT_EQ(part.kind, Block::Kind::kGround);
      expect_held(part);
      if (HasFatalFailure()) FAIL() << "trial " << trial;
    }
  }
  EXPECT_GT(divided, 50U);
  EXPECT_LT(divided, 1000U);
}

TEST_F(BlockTiles, WithoutImageryAreVoid) {
  place(slanted_block({-3000.0, 100.0}, 1.1, 0.3, 16, 0));
  ASSERT_EQ(band_.blocks.size(), 1U);
  EXPECT_EQ(band_.blocks[0].kind, Block::Kind::kVoid);
  // Across the imagery's left edge: the parts on either side.
  place(slanted_block({-20.0, 700.0}, 3.0, 0.0, 16, 0));
  int ground = 0, nothing = 0;
  for (const Block& part : band_.blocks) {
    (part.kind == Block::Kind::kVoid ? nothing : ground) += part.rows * part.columns;
    if (part.kind != Block::Kind::kVoid) continue;
    EXPECT_LT(texel_of(part, 0, 0).x(), 16.0);
  }
  EXPECT_EQ(ground + nothing, 256);
  EXPECT_GT(ground, 60);
}

TEST_F(BlockTiles, ShowImageryUpToItsEdge) {
  // Less than a tile's border from the left, upper, right and lower edge; the middle lies outside.
  for (const Eigen::Vector2d& texel : {Eigen::Vector2d(-12.0, 700.0),
                                       Eigen::Vector2d(700.0, -12.0),
                                       Eigen::Vector2d(4092.0, 700.0),
                                       Eigen::Vector2d(700.0, 4092.0)}) {
    const Block block = slanted_block(texel, 1.0, 0.0, 16, 0);
    place(block);
    int nothing = 0;
    for (const Block& part : band_.blocks) {
      if (part.kind != Block::Kind::kVoid) continue;
      for (int y = 0; y < part.rows; ++y) {
        for (int x = 0; x < part.columns; ++x) {
          const Eigen::Vector2d at = texel_of(part, x, y);
          EXPECT_TRUE(at.minCoeff() < 0.0 || at.maxCoeff() >= 4096.0) << at.transpose();
          ++nothing;
        }
      }
    }
    EXPECT_GE(nothing, 128);
    EXPECT_LT(nothing, 224);
  }
}

TEST_F(BlockTiles, BandsListEachTileOnce) {
  BlockPlaces places(ground_, band_);
  for (int i = 0; i < 8; ++i) {
    places.add(slanted_block({600.0 + 600.0 * (i % 2), 700.0}, 1.1, 0.0, 16 * i, 0));
  }
  ASSERT_EQ(band_.tiles.size(), 2U);
  EXPECT_EQ(band_.tiles[0], (terrain::TileId{0, 1, 1}));
  EXPECT_EQ(band_.tiles[1], (terrain::TileId{0, 2, 1}));
  for (const Block& block : band_.blocks) EXPECT_EQ(block.tile, block.x / 16 % 2);
}

TEST(TexelLod, IsTheLongerStepsLogarithm) {
  EXPECT_DOUBLE_EQ(texel_lod(3.0, 4.0, 0.0, 1.0), std::log2(5.0));
  EXPECT_DOUBLE_EQ(texel_lod(0.0, 0.1, -8.0, 0.0), 3.0);
  EXPECT_TRUE(std::isfinite(texel_lod(0.0, 0.0, 0.0, 0.0)));
}

}  // namespace
}  // namespace overfly::renderer::raycast
