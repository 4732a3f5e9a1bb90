// Handles on a raster that is taken away, replaced or written to while they are in use.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <future>

#include "terrain/raster/gdal_dataset.hpp"
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

}  // namespace
}  // namespace overfly::terrain
