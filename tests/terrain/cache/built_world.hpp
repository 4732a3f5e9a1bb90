// A small world of several layers and its built cache, for tests.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "terrain/build_world.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/layered_world.hpp"

namespace overfly::terrain {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

inline WorldSpec spec_of(const fs::path& manifest) {
  auto spec = read_world_manifest(manifest);
  if (!spec) throw std::runtime_error(spec.error().message);
  return std::move(*spec);
}

inline World opened(const WorldSpec& spec) {
  auto world = open_world(spec);
  if (!world) throw std::runtime_error(world.error().message);
  return std::move(*world);
}

inline World opened_without_cache(WorldSpec spec) {
  spec.cache_folder.clear();
  return opened(spec);
}

/// All tiles of all levels, one beyond the grid on every side.
inline std::vector<TileId> all_tiles(const TileGrid& grid) {
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

inline void expect_same_tiles(const World& a, const World& b) {
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

inline void expect_same_ground(const World& a, const World& b) {
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

inline std::vector<fs::path> chunks_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".chunk") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

inline void flip_byte(const fs::path& file, std::size_t at) {
  std::string bytes = testing::read_text(file);
  bytes.at(at) = static_cast<char>(bytes.at(at) ^ 0x40);
  testing::write_text(file, bytes);
}

inline BuildReport built(const WorldSpec& spec) {
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

}  // namespace overfly::terrain
