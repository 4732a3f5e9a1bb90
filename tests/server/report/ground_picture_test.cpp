// The picture of the ground against a world whose colour follows from the place.
#include "server/report/figures/ground_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/support.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::server::report {
namespace {

constexpr double kSizeM = 4096.0;
/// The map plane lies turned in the world, as a grid away from its meridian does.
constexpr double kTurnRad = 0.02;

/// Imagery of 1 m over [0, kSizeM] x [0, kSizeM] of the map: red grows to the east, green to the
/// north, by 1 every 16 m; blue is the level.
class ColouredGround final : public terrain::TileSource {
 public:
  ColouredGround() : frame_(geodetic_from_deg(47.0, 8.0, 0.0)) {
    grid_.left_x_m = 0.0;
    grid_.top_y_m = kSizeM;
    grid_.levels = 4;
    grid_.cols = 8;
    grid_.rows = 8;
    grid_.width_m = kSizeM;
    grid_.height_m = kSizeM;
  }
  [[nodiscard]] const terrain::TileGrid& grid() const override { return grid_; }
  [[nodiscard]] terrain::TileCoverage coverage(const terrain::TileId& id) const override {
    const int tiles = 8 >> id.level;
    const bool inside = id.col >= 0 && id.row >= 0 && id.col < tiles && id.row < tiles;
    return inside ? terrain::TileCoverage::kFull : terrain::TileCoverage::kNone;
  }
  [[nodiscard]] Eigen::Vector3d world_from_map(double x, double y) const override {
    return {std::cos(kTurnRad) * x - std::sin(kTurnRad) * y,
            std::sin(kTurnRad) * x + std::cos(kTurnRad) * y,
            0.0};
  }
  [[nodiscard]] Eigen::Vector2d map_from_world(double east, double north) const override {
    return {std::cos(kTurnRad) * east + std::sin(kTurnRad) * north,
            -std::sin(kTurnRad) * east + std::cos(kTurnRad) * north};
  }
  [[nodiscard]] bool has_imagery(double, double) const override { return true; }
  [[nodiscard]] const LocalFrame& frame() const override { return frame_; }
  [[nodiscard]] Eigen::Vector2d height_range_m() const override { return {0.0, 0.0}; }
  [[nodiscard]] std::string attribution() const override { return "test"; }
  [[nodiscard]] double ground_up_m(double, double) const override { return 0.0; }

 private:
  [[nodiscard]] Result<terrain::Tile> read_tile(
      const terrain::TileId& id, const terrain::Cancelled& cancelled) const override {
    if (cancelled && cancelled()) return Error{ErrorCode::kCancelled, "cancelled"};
    const double texel_m = grid_.texel_m * (1 << id.level);
    terrain::Tile tile{Image(terrain::kTileSide, terrain::kTileSide, 3),
                       Image(terrain::kTileSide, terrain::kTileSide, 1, 255)};
    for (int y = 0; y < terrain::kTileSide; ++y) {
      for (int x = 0; x < terrain::kTileSide; ++x) {
        const double east =
            (id.col * terrain::kTileTexels + x - terrain::kTileBorder + 0.5) * texel_m;
        const double south =
            (id.row * terrain::kTileTexels + y - terrain::kTileBorder + 0.5) * texel_m;
        tile.rgb.at(x, y, 0) = byte_of(east);
        tile.rgb.at(x, y, 1) = byte_of(kSizeM - south);
        tile.rgb.at(x, y, 2) = static_cast<std::uint8_t>(id.level);
      }
    }
    return tile;
  }
  static std::uint8_t byte_of(double metres) {
    return static_cast<std::uint8_t>(std::clamp(metres / 16.0, 0.0, 255.0));
  }

  terrain::TileGrid grid_;
  LocalFrame frame_;
};

TEST(GroundPicture, ShowsEachPlaceNorthUp) {
  const ColouredGround ground;
  const GroundExtent extent{900.0, 2900.0, 700.0, 2200.0};
  const auto picture = ground_picture(ground, extent, 400, 300);
  ASSERT_TRUE(picture.ok()) << picture.error().message;
  ASSERT_EQ(picture->channels, 3);
  for (int y = 0; y < 300; y += 7) {
    for (int x = 0; x < 400; x += 7) {
      const Eigen::Vector2d map =
          ground.map_from_world(900.0 + 5.0 * (x + 0.5), 2200.0 - 5.0 * (y + 0.5));
      ASSERT_NEAR(picture->at(x, y, 0), map.x() / 16.0 - 0.5, 1.0) << x << ", " << y;
      ASSERT_NEAR(picture->at(x, y, 1), map.y() / 16.0 - 0.5, 1.0) << x << ", " << y;
    }
  }
  EXPECT_EQ(picture->at(5, 5, 2), 2);  // texels of 4 m for pixels of 5 m
}

TEST(GroundPicture, IsVoidWhereThereIsNoImagery) {
  const ColouredGround ground;
  const auto picture = ground_picture(ground, {-1000.0, 1000.0, -1000.0, 1000.0}, 100, 100);
  ASSERT_TRUE(picture.ok());
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_EQ(picture->at(10, 10, channel), terrain::kVoidRgb[channel]);
    EXPECT_EQ(picture->at(90, 90, channel), terrain::kVoidRgb[channel]);
  }
  EXPECT_NE(picture->at(90, 10, 0), terrain::kVoidRgb[0]);
  // Far away, and from very high above.
  ASSERT_TRUE(ground_picture(ground, {1e9, 1e9 + 10.0, -1e9, -1e9 + 10.0}, 10, 10).ok());
  ASSERT_TRUE(ground_picture(ground, {-1e7, 1e7, -1e7, 1e7}, 64, 64).ok());
}

TEST(GroundPicture, CanBeCancelled) {
  const ColouredGround ground;
  const auto picture =
      ground_picture(ground, {0.0, 100.0, 0.0, 100.0}, 10, 10, [] { return true; });
  ASSERT_FALSE(picture.ok());
  EXPECT_EQ(picture.error().code, ErrorCode::kCancelled);
}

/// A world from files: the texel under the picture's centre.
TEST(GroundPicture, OfAWorldFromFilesAgreesWithItsTiles) {
  const overfly::testing::TemporaryFolder folder;
  const auto world = terrain::open_world(overfly::testing::write_synthetic_world(folder.path()));
  ASSERT_TRUE(world.ok()) << world.error().message;
  const terrain::TileSource& tiles = *world->tiles;
  const double texel_m = tiles.grid().texel_m;
  const auto picture = ground_picture(tiles, {-40.0, 40.0, -40.0, 40.0}, 160, 160);
  ASSERT_TRUE(picture.ok()) << picture.error().message;
  double difference = 0.0;
  int compared = 0;
  for (int y = 3; y < 160; y += 13) {
    for (int x = 3; x < 160; x += 13) {
      const Eigen::Vector2d map =
          tiles.map_from_world(-40.0 + 0.5 * (x + 0.5), 40.0 - 0.5 * (y + 0.5));
      const double across = (map.x() - tiles.grid().left_x_m) / texel_m;
      const double down = (tiles.grid().top_y_m - map.y()) / texel_m;
      const int col = static_cast<int>(across) / terrain::kTileTexels;
      const int row = static_cast<int>(down) / terrain::kTileTexels;
      const auto tile = tiles.tile({0, col, row});
      ASSERT_TRUE(tile.ok());
      const int tile_x = static_cast<int>(across) - col * terrain::kTileTexels;
      const int tile_y = static_cast<int>(down) - row * terrain::kTileTexels;
      difference +=
          std::abs(picture->at(x, y, 1) -
                   tile->rgb.at(tile_x + terrain::kTileBorder, tile_y + terrain::kTileBorder, 1));
      ++compared;
    }
  }
  // The nearest texel differs from the interpolated colour by less than the texture's contrast.
  EXPECT_LT(difference / compared, 12.0);
}

}  // namespace
}  // namespace overfly::server::report
