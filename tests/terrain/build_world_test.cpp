// A built world is the files' world: same bytes, sooner; and never another picture.
#include "terrain/build_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>

#include "tests/support/support.hpp"
#include "tests/terrain/layered_world.hpp"

namespace overfly::terrain {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

WorldSpec spec_of(const fs::path& manifest) {
  auto spec = read_world_manifest(manifest);
  if (!spec) throw std::runtime_error(spec.error().message);
  return std::move(*spec);
}

World opened(const WorldSpec& spec) {
  auto world = open_world(spec);
  if (!world) throw std::runtime_error(world.error().message);
  return std::move(*world);
}

World opened_without_cache(WorldSpec spec) {
  spec.cache_folder.clear();
  return opened(spec);
}

/// All tiles of all levels, one beyond the grid on every side.
std::vector<TileId> all_tiles(const TileGrid& grid) {
  std::vector<TileId> ids;
  for (int level = 0; level < grid.levels; ++level) {
    for (int row = -1; row <= ((grid.rows - 1) >> level) + 1; ++row) {
      for (int col = -1; col <= ((grid.cols - 1) >> level) + 1; ++col) {
        ids.push_back({level, col, row});
      }
    }
  }
  return ids;
}

void expect_same_tiles(const World& a, const World& b) {
  ASSERT_EQ(a.tiles->grid().levels, b.tiles->grid().levels);
  for (const TileId& id : all_tiles(a.tiles->grid())) {
    const auto in_a = a.tiles->tile(id);
    const auto in_b = b.tiles->tile(id);
    ASSERT_TRUE(in_a) << in_a.error().message;
    ASSERT_TRUE(in_b) << in_b.error().message;
    ASSERT_EQ(in_a->rgb.data, in_b->rgb.data) << id.level << ' ' << id.col << ' ' << id.row;
    ASSERT_EQ(in_a->valid.data, in_b->valid.data) << id.level << ' ' << id.col << ' ' << id.row;
    EXPECT_EQ(a.tiles->coverage(id), b.tiles->coverage(id));
  }
}

void expect_same_ground(const World& a, const World& b) {
  const TileGrid& grid = a.tiles->grid();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(-1.0, 2.0);
  for (int i = 0; i < 500; ++i) {
    const double x = grid.left_x_m + along(random) * grid.width_m;
    const double y = grid.top_y_m - along(random) * grid.height_m;
    EXPECT_EQ(a.tiles->world_from_map(x, y), b.tiles->world_from_map(x, y));
    EXPECT_EQ(a.tiles->coarse_world_from_map(x, y, 40.0),
              b.tiles->coarse_world_from_map(x, y, 40.0));
    EXPECT_EQ(a.tiles->has_imagery(x, y), b.tiles->has_imagery(x, y));
  }
  EXPECT_EQ(a.tiles->height_range_m(), b.tiles->height_range_m());
  EXPECT_EQ(a.tiles->frame().origin().alt_ellipsoid_m, b.tiles->frame().origin().alt_ellipsoid_m);
}

std::vector<fs::path> chunks_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".chunk") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void flip_byte(const fs::path& file, std::size_t at) {
  std::string bytes = testing::read_text(file);
  bytes.at(at) = static_cast<char>(bytes.at(at) ^ 0x40);
  testing::write_text(file, bytes);
}

BuildReport built(const WorldSpec& spec) {
  auto report = build_world(spec);
  if (!report) throw std::runtime_error(report.error().message);
  return std::move(*report);
}

/// A world that was written once, copied for each test.
class BuildWorld : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    pattern_ = std::make_unique<TemporaryFolder>();
    (void)testing::write_layered_world(pattern_->path());
  }
  static void TearDownTestSuite() { pattern_.reset(); }

  void SetUp() override {
    copy_world(pattern_->path());
    spec_ = spec_of(folder_.path() / "world.json");
  }
  /// Times too, as `cp -p` does.
  void copy_world(const fs::path& from) {
    fs::copy(
        from, folder_.path(), fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    for (const auto& entry : fs::recursive_directory_iterator(from)) {
      fs::last_write_time(folder_.path() / fs::relative(entry.path(), from),
                          fs::last_write_time(entry.path()));
    }
  }
  BuildReport build() { return built(spec_); }

  inline static std::unique_ptr<TemporaryFolder> pattern_;
  TemporaryFolder folder_;
  WorldSpec spec_;
};

/// The same with its cache.
class BuiltWorld : public BuildWorld {
 protected:
  static void SetUpTestSuite() {
    BuildWorld::SetUpTestSuite();
    report_ = built(spec_of(pattern_->path() / "world.json"));
  }

  void SetUp() override {
    BuildWorld::SetUp();
    cache_ = spec_.cache_folder / report_.folder.filename();
  }

  inline static BuildReport report_;
  fs::path cache_;
};

TEST_F(BuildWorld, GivesTheSameBytesAsReadingTheFiles) {
  const World files = opened_without_cache(spec_);
  EXPECT_EQ(files.cache, "none");
  const BuildReport report = build();
  EXPECT_FALSE(report.was_fresh);
  EXPECT_GT(report.chunks_made, 0);
  EXPECT_EQ(report.folder.parent_path(), folder_.path() / "world.cache");
  const World built = opened(spec_);
  EXPECT_THAT(built.cache, HasSubstr("in use: "));
  expect_same_tiles(files, built);
  expect_same_ground(files, built);
  EXPECT_EQ(built.warnings, files.warnings);
  EXPECT_EQ(built.data_hashes, files.data_hashes);
  EXPECT_TRUE(built.tiles->status());
}

TEST_F(BuiltWorld, HasNothingToDoTheSecondTime) {
  const BuildReport second = build();
  EXPECT_TRUE(second.was_fresh);
  EXPECT_EQ(second.chunks_made, 0);
  EXPECT_EQ(second.folder, cache_);
  EXPECT_EQ(second.bytes, report_.bytes);
}

TEST_F(BuildWorld, StopsWhenToldToAndIsNoCacheUntilItIsWhole) {
  std::vector<std::string> heard;
  const auto stopped = build_world(spec_, [&](double share, const std::string& doing) {
    EXPECT_GE(share, 0.0);
    EXPECT_LE(share, 1.0);
    heard.push_back(doing);
    return doing.find("chunks") == std::string::npos;
  });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
  EXPECT_THAT(heard, ::testing::Contains(HasSubstr("reading near.tif")));
  EXPECT_EQ(opened(spec_).cache, "none");
}

TEST_F(BuiltWorld, DoesOnlyTheRestAfterTheDiskWasFull) {
  const World files = opened_without_cache(spec_);
  fs::path largest;
  for (const fs::path& file : chunks_below(cache_)) {
    if (largest.empty() || fs::file_size(file) > fs::file_size(largest)) largest = file;
  }
  const auto size = fs::file_size(largest);
  fs::remove(largest);
  fs::remove(cache_ / "cache.json");

  // Files larger than this cannot be written: what a full disk does, in this process alone.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = size - 1;
  std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto full = build_world(spec_);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_DFL);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, ErrorCode::kIo);
  EXPECT_THAT(full.error().message, HasSubstr(largest.filename().string()));
  EXPECT_THAT(full.error().message, HasSubstr("cannot be written: File too large"));
  EXPECT_EQ(opened(spec_).cache, "none") << "half a cache must not be used";

  const BuildReport rest = build();
  EXPECT_EQ(rest.chunks_made, 1);
  EXPECT_EQ(rest.chunks_kept, report_.chunks_made - 1);
  expect_same_tiles(files, opened(spec_));
}

TEST_F(BuildWorld, LeavesARightCacheWhenTwoProcessesBuildAtOnce) {
  std::vector<pid_t> children;
  for (int i = 0; i < 2; ++i) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) _exit(build_world(spec_) ? 0 : 1);
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  }
  const World built = opened(spec_);
  EXPECT_THAT(built.cache, HasSubstr("in use"));
  expect_same_tiles(opened_without_cache(spec_), built);
  EXPECT_EQ(std::distance(fs::directory_iterator(spec_.cache_folder), {}), 1);
}

TEST_F(BuiltWorld, GoesOnAfterItWasKilledInTheMiddleOfWriting) {
  const fs::path largest = cache_ / "tiles/0/x0y0.chunk";
  const auto size = fs::file_size(largest);
  const std::string bytes = testing::read_text(largest);
  fs::remove(largest);
  fs::remove(cache_ / "tiles/1/x0y0.chunk");
  fs::remove(cache_ / "cache.json");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    // The signal of a file that grows too large ends the process within the write.
    const rlimit small{size / 2, size / 2};
    setrlimit(RLIMIT_FSIZE, &small);
    std::signal(SIGXFSZ, SIG_DFL);
    _exit(build_world(spec_) ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << status;
  EXPECT_EQ(opened(spec_).cache, "none");
  EXPECT_FALSE(fs::exists(largest)) << "half a file";
  const BuildReport report = build();
  EXPECT_GE(report.chunks_kept, report_.chunks_made - 2);
  EXPECT_EQ(report.chunks_kept + report.chunks_made, report_.chunks_made);
  EXPECT_EQ(testing::read_text(largest), bytes);
}

TEST_F(BuiltWorld, NoticesAChangedFileAndIsMadeAgain) {
  TemporaryFolder elsewhere;
  (void)testing::write_layered_world(elsewhere.path(), {77, -1});
  fs::copy_file(elsewhere.path() / "near.tif",
                folder_.path() / "near.tif",
                fs::copy_options::overwrite_existing);
  const World changed = opened(spec_);
  EXPECT_THAT(changed.cache, HasSubstr("stale: near.tif has "));
  EXPECT_THAT(changed.warnings, ::testing::Contains(HasSubstr("Run `overfly world build`")));
  expect_same_tiles(opened_without_cache(spec_), changed);
  const BuildReport after = build();
  EXPECT_NE(after.folder, cache_);
  EXPECT_FALSE(fs::exists(cache_)) << "the old cache is of no use to anybody";
  EXPECT_THAT(opened(spec_).cache, HasSubstr("in use"));
}

TEST_F(BuiltWorld, NoticesAChangeThatKeepsSizeAndSaysWhich) {
  const fs::path file = folder_.path() / "far_heights.tif";
  flip_byte(file, fs::file_size(file) - 40);
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(5));
  EXPECT_EQ(opened(spec_).cache, "stale: far_heights.tif has changed");
}

TEST_F(BuiltWorld, IsStillGoodWhenAFileWasOnlyCopied) {
  const fs::path file = folder_.path() / "near.tif";
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::hours(1));
  EXPECT_THAT(opened(spec_).cache, HasSubstr("in use"));
  EXPECT_TRUE(build().was_fresh);
}

TEST_F(BuiltWorld, NoticesAChangedManifestButNotItsWords) {
  WorldSpec spec = spec_;
  spec.name = "Another name";
  spec.imagery[0].attribution = "Somebody";
  EXPECT_THAT(opened(spec).cache, HasSubstr("in use"));
  spec.elevation[1].geoid_separation_m = 1.0;
  spec.elevation[1].datum = VerticalDatum::kUnknown;
  EXPECT_EQ(opened(spec).cache, "stale: the manifest has changed");
  spec = spec_;
  std::swap(spec.imagery[0], spec.imagery[1]);
  EXPECT_EQ(opened(spec).cache, "stale: the manifest has changed");
}

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
  const TileGrid& grid = world->tiles->grid();
  (void)world->tiles->world_from_map(grid.left_x_m + 100.0, grid.top_y_m - 100.0);
  for (const auto& [id, expected] : right) {
    const auto tile = world->tiles->tile(id);
    if (tile) {
      EXPECT_TRUE(tile->rgb.data == expected.rgb.data) << damaged;
      continue;
    }
    noticed = true;
    EXPECT_EQ(tile.error().code, ErrorCode::kIo);
    EXPECT_THAT(tile.error().message, HasSubstr(damaged.string()));
    EXPECT_THAT(tile.error().message, HasSubstr("`overfly world build`"));
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
    // The magic word, the first piece's place, its check, the first piece.
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
  const BuildReport mended = build();
  EXPECT_FALSE(mended.was_fresh);
  EXPECT_EQ(mended.chunks_made, 2);
  EXPECT_EQ(mended.chunks_kept, report_.chunks_made - 2);
  flip_byte(cache_ / "validity-0", 40);
  EXPECT_EQ(build().chunks_made, 0);
  const World built = opened(spec_);
  expect_same_tiles(files, built);
  expect_same_ground(files, built);
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

TEST_F(BuildWorld, LeavesOtherFilesInItsFolderAlone) {
  fs::create_directories(spec_.cache_folder / "0123456789abcdef");
  testing::write_text(spec_.cache_folder / "0123456789abcdef" / "diary.txt", "mine");
  testing::write_text(spec_.cache_folder / "notes.txt", "mine too");
  (void)build();
  EXPECT_TRUE(fs::exists(spec_.cache_folder / "0123456789abcdef" / "diary.txt"));
  EXPECT_TRUE(fs::exists(spec_.cache_folder / "notes.txt"));
}

TEST_F(BuiltWorld, MayBeMovedTogetherWithItsFiles) {
  TemporaryFolder elsewhere;
  fs::copy(folder_.path(), elsewhere.path() / "moved", fs::copy_options::recursive);
  const World moved = opened(spec_of(elsewhere.path() / "moved" / "world.json"));
  EXPECT_THAT(moved.cache, HasSubstr("in use"));
}

TEST_F(BuildWorld, NeedsAPlaceForTheCache) {
  spec_.cache_folder.clear();
  const auto report = build_world(spec_);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(report.error().message, HasSubstr("no manifest"));
}

}  // namespace
}  // namespace overfly::terrain
