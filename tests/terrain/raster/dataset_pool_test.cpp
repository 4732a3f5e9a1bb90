// Handles on a raster that is taken away, replaced or written to while they are in use, and handles
// that serve several threads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <future>
#include <vector>

#include "terrain/raster/gdal_dataset.hpp"
#include "terrain/synthesize_strip.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class DatasetPoolTest : public ::testing::Test {
 protected:
  DatasetPoolTest() { testing::write_raster(file(), {}); }
  [[nodiscard]] fs::path file() const { return folder_.path() / "a.tif"; }
  [[nodiscard]] fs::path other() const { return folder_.path() / "b.tif"; }

  void expect_io_error(DatasetPool& pool, const std::string& why) {
    const auto taken = pool.take();
    ASSERT_FALSE(taken.ok());
    EXPECT_EQ(taken.error().code, ErrorCode::kIo);
    EXPECT_EQ(taken.error().message, file().string() + why);
  }

 private:
  testing::TemporaryFolder folder_;
};

TEST_F(DatasetPoolTest, AFileThatVanishedIsAFaultOfReading) {
  DatasetPool pool(file(), 0);
  fs::remove(file());
  expect_io_error(pool, ": was removed after the world was opened");
}

TEST_F(DatasetPoolTest, AnotherFileOfThatNameIsNotRead) {
  DatasetPool pool(file(), 0);
  testing::write_raster(other(), {});
  fs::rename(other(), file());
  expect_io_error(pool, ": was replaced while it was in use");
}

TEST_F(DatasetPoolTest, AFileWrittenToIsNotRead) {
  DatasetPool pool(file(), 0, open_raster(file()).value());
  fs::resize_file(file(), 1000);
  expect_io_error(pool, ": was modified while it was in use");
}

TEST_F(DatasetPoolTest, OpenHandlesOfAVanishedFileAreShared) {
  DatasetPool pool(file(), 0, open_raster(file()).value());
  fs::remove(file());
  auto mine = pool.take();
  ASSERT_TRUE(mine.ok()) << mine.error().message;
  GDALDataset* const only = mine->get();
  auto theirs = std::async(std::launch::async, [&] { return pool.take(); });
  pool.put(std::move(*mine));
  const auto taken = theirs.get();
  ASSERT_TRUE(taken.ok()) << taken.error().message;
  EXPECT_EQ(taken->get(), only);
}

constexpr int kSidePx = 256;

/// A window of a raster's three bands.
std::vector<std::uint8_t> read_window(GDALDataset& dataset, int x_px, int y_px) {
  std::vector<std::uint8_t> texels(std::size_t{3} * kSidePx * kSidePx);
  const CPLErr read = dataset.RasterIO(GF_Read,
                                       x_px,
                                       y_px,
                                       kSidePx,
                                       kSidePx,
                                       texels.data(),
                                       kSidePx,
                                       kSidePx,
                                       GDT_Byte,
                                       3,
                                       nullptr,
                                       3,
                                       GSpacing{3} * kSidePx,
                                       1,
                                       nullptr);
  return read == CE_None ? texels : std::vector<std::uint8_t>{};
}

TEST(VirtualRaster, HandlesOpenedByOneThreadServeSeveral) {
  const testing::TemporaryFolder folder;
  StripOptions options;
  options.length_m = 2000.0;
  options.width_m = 1000.0;
  ASSERT_TRUE(synthesize_strip(folder.path() / "strip", options).ok());
  const fs::path file = folder.path() / "strip" / "imagery.vrt";
  constexpr int kLevel = 1;  // in a virtual raster of its own
  const auto alone = open_raster(file, kLevel).value();
  const int columns = alone->GetRasterXSize() / kSidePx;
  const int windows = columns * (alone->GetRasterYSize() / kSidePx);
  ASSERT_GT(windows, 8);
  const auto window = [&](GDALDataset& dataset, int i) {
    return read_window(dataset, i % columns * kSidePx, i / columns * kSidePx);
  };
  for (int round = 0; round < 5; ++round) {
    const auto mine = open_raster(file, kLevel).value();
    const auto theirs = open_raster(file, kLevel).value();
    std::vector<std::vector<std::uint8_t>> read(static_cast<std::size_t>(windows));
    std::atomic<int> next{0};
    const auto work = [&](GDALDataset& dataset) {
      for (int i = next++; i < windows; i = next++) read[i] = window(dataset, i);
    };
    auto other = std::async(std::launch::async, [&] { work(*theirs); });
    work(*mine);
    other.get();
    for (int i = 0; i < windows; ++i) EXPECT_TRUE(read[i] == window(*alone, i)) << i;
  }
}

}  // namespace
}  // namespace overfly::terrain
