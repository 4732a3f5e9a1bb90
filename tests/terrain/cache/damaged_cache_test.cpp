// A damaged cache is reported or repaired, and never gives another picture.
#include "terrain/cache/block_codec.hpp"
#include "terrain/cache/chunk_file.hpp"
#include "terrain/height_errors.hpp"
#include "tests/terrain/cache/built_world.hpp"

namespace overfly::terrain {
namespace {

/// What a cache with one damaged file answers: an error that names the file, or the right bytes.
void expect_error_or_same(const WorldSpec& spec,
                          const fs::path& damaged,
                          const std::vector<std::pair<TileId, Tile>>& right) {
  const auto world = open_world(spec);
  if (!world) {
    EXPECT_THAT(world.error().message, HasSubstr(damaged.filename().string()));
    EXPECT_THAT(world.error().message, HasSubstr("`overfly world build`"));
    return;
  }
  bool noticed = false;
  const auto expect_named = [&](const Error& error) {
    noticed = true;
    EXPECT_EQ(error.code, ErrorCode::kIo);
    EXPECT_THAT(error.message, HasSubstr(damaged.string()));
    EXPECT_THAT(error.message, HasSubstr("`overfly world build`"));
  };
  const HeightErrors errors;
  const TileGrid& grid = world->tiles->grid();
  // Beyond the north-western corner, where the first block of heights answers.
  (void)world->tiles->world_from_map(grid.left_x_m - grid.width_m, grid.top_y_m + grid.height_m);
  if (const Status heights = errors.status(); !heights) expect_named(heights.error());
  for (const auto& [id, expected] : right) {
    const auto tile = world->tiles->tile(id);
    if (tile) {
      EXPECT_TRUE(tile->rgb.data == expected.rgb.data) << damaged;
      continue;
    }
    expect_named(tile.error());
  }
  EXPECT_TRUE(noticed) << damaged;
}

TEST_F(BuiltWorld, NeverShowsADamagedPart) {
  const World files = opened_without_cache(spec_);
  std::vector<std::pair<TileId, Tile>> right;
  for (const TileId id : {TileId{0, 0, 0}, TileId{0, 1, 0}, TileId{0, 1, 1}, TileId{0, 2, 2}}) {
    right.emplace_back(id, *files.tiles->tile(id));
  }
  const fs::path tile = cache_ / "tiles/0/x0y0.chunk";
  const fs::path heights = cache_ / "heights/0/x0y0.chunk";
  for (const fs::path& file : {tile, heights, cache_ / "validity-0"}) {
    const std::string bytes = testing::read_text(file);
    ASSERT_GT(bytes.size(), 50U) << file;
    // The magic number, the first piece's offset, its checksum, the first piece.
    const std::size_t first =
        static_cast<unsigned char>(bytes[12]) | static_cast<unsigned char>(bytes[13]) << 8;
    for (const std::size_t at : {std::size_t{0}, std::size_t{13}, std::size_t{25}, first + 9}) {
      flip_byte(file, at);
      expect_error_or_same(spec_, file, right);
      testing::write_text(file, bytes);
    }
    testing::write_text(file, bytes.substr(0, first + 9));
    expect_error_or_same(spec_, file, right);
    fs::remove(file);
    expect_error_or_same(spec_, file, right);
    testing::write_text(file, bytes);
  }
  expect_same_tiles(files, opened(spec_));
}

TEST_F(BuiltWorld, MendsWhatIsDamaged) {
  const World files = opened_without_cache(spec_);
  const fs::path tile = cache_ / "tiles/0/x0y0.chunk";
  const fs::path heights = cache_ / "heights/0/x0y0.chunk";
  flip_byte(tile, fs::file_size(tile) / 2);
  fs::resize_file(heights, 0);
  const BuildReport repaired = build();
  EXPECT_FALSE(repaired.was_fresh);
  EXPECT_EQ(repaired.chunks_made, 2);
  EXPECT_EQ(repaired.chunks_kept, report_.chunks_made - 2);
  flip_byte(cache_ / "validity-0", 40);
  EXPECT_EQ(build().chunks_made, 0);
  const World built = opened(spec_);
  expect_same_tiles(files, built);
  expect_same_ground(files, built);
}

TEST_F(BuiltWorld, DoesNotTrustAMaskOfAnotherRaster) {
  const fs::path file = cache_ / "validity-0";
  const std::string whole = testing::read_text(file);
  const Bytes mask = unpack_bytes(read_piece(file, 0).value()).value();
  // Cell size, columns, rows, width and height, four bytes each.
  Bytes swapped = mask;
  std::swap_ranges(swapped.begin() + 4, swapped.begin() + 8, swapped.begin() + 8);
  Bytes wider = mask;
  wider[12] ^= 1U;
  Bytes higher = mask;
  higher[16] ^= 1U;
  for (const Bytes& bent : {swapped, wider, higher}) {
    ASSERT_TRUE(write_chunk(file, {pack_bytes(bent)}));
    const auto world = open_world(spec_);
    ASSERT_FALSE(world.ok());
    EXPECT_EQ(world.error().message, file.string() + ": is damaged");
  }
  testing::write_text(file, whole);
  EXPECT_TRUE(open_world(spec_).ok());
}

TEST(BlockCodec, AllocatesNothingForABlockOfAnotherSize) {
  // As the largest block of heights declares its size, with the method's number behind.
  EXPECT_FALSE(unpack_heights(Bytes{0xff, 0xff, 0, 1, 2, 3}));
  HeightGrid small{3, 3, std::vector<float>(9, 1.0F)};
  EXPECT_FALSE(unpack_heights(pack_heights(small)));
}

TEST_F(BuiltWorld, DoesNotTrustADamagedTableOfContents) {
  const fs::path header = cache_ / "cache.json";
  const std::string text = testing::read_text(header);
  const std::size_t chunk = text.find("\"chunks\"");
  ASSERT_NE(chunk, std::string::npos);
  const std::size_t digit = text.find('0', chunk);
  std::string bent = text;
  bent[digit] = '7';
  for (const std::string& bad : {text.substr(0, text.size() / 2), bent, std::string()}) {
    testing::write_text(header, bad);
    const World world = opened(spec_);
    EXPECT_EQ(world.cache, "stale: its cache.json is damaged or of another version");
  }
  EXPECT_EQ(build().chunks_made, 0) << "the chunks themselves are good";
  EXPECT_EQ(testing::read_text(header), text);
}

}  // namespace
}  // namespace overfly::terrain
