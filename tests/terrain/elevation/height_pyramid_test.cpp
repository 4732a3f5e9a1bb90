// Paged heights against the whole raster in memory.
#include "terrain/elevation/height_pyramid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include "terrain/height_errors.hpp"

namespace overfly::terrain {
namespace {

/// Hills with a large hole, small ones, and a void edge.
HeightGrid holed_grid(int columns, int rows) {
  HeightGrid grid{columns, rows, {}};
  grid.heights_m.resize(static_cast<std::size_t>(columns) * rows);
  std::mt19937 random(5);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const bool hole = std::hypot(i - 400.0, j - 300.0) < 170.0 || random() % 50 == 0 || i < 3;
      grid.at(i, j) = hole ? std::numeric_limits<float>::quiet_NaN()
                           : static_cast<float>(100.0 + 20.0 * std::sin(0.031 * i) +
                                                15.0 * std::cos(0.017 * j + 0.01 * i));
    }
  }
  return grid;
}

PostReader reader_of(const HeightGrid& grid) {
  return [&grid](int column, int row, int columns, int rows) -> Result<RawPosts> {
    RawPosts posts;
    posts.grid = {columns, rows, {}};
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        posts.grid.heights_m.push_back(grid.at(column + i, row + j));
      }
    }
    return posts;
  };
}

TEST(HeightPyramid, FillsHolesAsTheWholeRasterInMemoryDoesWhateverFitsIntoMemory) {
  const HeightGrid raw = holed_grid(1100, 700);
  HeightGrid whole = raw;
  const std::size_t holes = fill_voids(whole);
  for (const std::size_t budget : {std::size_t{300} << 10U, std::size_t{64} << 20U}) {
    HeightPyramid pyramid(
        raw.columns, raw.rows, std::make_shared<BlockCache>(budget), reader_of(raw));
    const auto survey = pyramid.survey();
    ASSERT_TRUE(survey);
    EXPECT_EQ(survey->voids, static_cast<double>(holes));
    for (int j = 0; j < raw.rows; ++j) {
      for (int i = 0; i < raw.columns; ++i) {
        ASSERT_EQ(pyramid.filled().bilinear(0, i, j), whole.at(i, j)) << i << ", " << j;
      }
    }
    EXPECT_EQ(pyramid.filled().bilinear(0, 255.25, 511.75), whole.bilinear(255.25, 511.75));
    EXPECT_EQ(pyramid.filled().bilinear(0, 1e6, -5.0), whole.at(1099, 0));
  }
}

TEST(HeightPyramid, AnswersTheSameWithAndWithoutASurvey) {
  const HeightGrid raw = holed_grid(600, 530);
  const auto cache = std::make_shared<BlockCache>(std::size_t{1} << 20U);
  HeightPyramid read_once(raw.columns, raw.rows, cache, reader_of(raw));
  ASSERT_TRUE(read_once.survey());
  const HeightPyramid read_when_asked(raw.columns, raw.rows, cache, reader_of(raw));
  for (int level = 0; level < read_once.filled().levels(); ++level) {
    for (int j = 0; j < read_once.filled().rows(level); j += 7) {
      for (int i = 0; i < read_once.filled().columns(level); i += 7) {
        ASSERT_EQ(read_once.filled().bilinear(level, i, j),
                  read_when_asked.filled().bilinear(level, i, j));
      }
    }
  }
}

TEST(HeightPyramid, LevelsAreAveragesAndTheLastIsOnePost) {
  HeightGrid raw{513, 300, {}};
  double sum = 0.0;
  for (int k = 0; k < raw.columns * raw.rows; ++k) {
    raw.heights_m.push_back(static_cast<float>((k * 7919) % 1000));
  }
  HeightPyramid pyramid(
      raw.columns, raw.rows, std::make_shared<BlockCache>(std::size_t{8} << 20U), reader_of(raw));
  ASSERT_TRUE(pyramid.survey());
  const PagedHeights& heights = pyramid.filled();
  EXPECT_EQ(heights.columns(heights.levels() - 1), 1);
  EXPECT_EQ(heights.rows(heights.levels() - 1), 1);
  // Level 3's post (20, 30) stands for the posts (160..167, 240..247).
  for (int j = 240; j < 248; ++j) {
    for (int i = 160; i < 168; ++i) sum += raw.at(i, j);
  }
  EXPECT_NEAR(heights.bilinear(3, 20, 30), sum / 64.0, 1e-3);
}

TEST(HeightPyramid, KeepsToItsBudgetAndServesThreads) {
  const HeightGrid raw = holed_grid(1500, 900);
  const auto cache = std::make_shared<BlockCache>(std::size_t{1} << 20U);
  HeightPyramid pyramid(raw.columns, raw.rows, cache, reader_of(raw));
  ASSERT_TRUE(pyramid.survey());
  const PagedHeights& heights = pyramid.filled();
  std::vector<double> sums(3, 0.0);
  std::vector<std::thread> threads;
  for (double& sum : sums) {
    threads.emplace_back([&heights, &sum] {
      std::mt19937 random(3);
      for (int k = 0; k < 3000; ++k) {
        sum += heights.bilinear(static_cast<int>(random() % 3), random() % 1500, random() % 900);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_EQ(sums[0], sums[2]);
  EXPECT_LE(cache->bytes(), std::size_t{1} << 20U);
}

TEST(HeightPyramid, RemembersWhatWentWrong) {
  const auto cache = std::make_shared<BlockCache>(std::size_t{1} << 20U);
  const HeightPyramid pyramid(600, 600, cache, [](int column, int, int, int) -> Result<RawPosts> {
    return Error{ErrorCode::kIo, "no posts at " + std::to_string(column)};
  });
  EXPECT_FALSE(pyramid.filled().read_error());
  EXPECT_TRUE(std::isnan(pyramid.filled().bilinear(0, 300.0, 5.0)));
  ASSERT_TRUE(pyramid.filled().read_error());
  EXPECT_EQ(pyramid.filled().read_error()->code, ErrorCode::kIo);
  EXPECT_EQ(pyramid.filled().read_error()->message, "no posts at 256");
}

TEST(HeightPyramid, AnErrorEndsNoOtherQuery) {
  const HeightGrid raw{600, 600, std::vector<float>(std::size_t{600} * 600, 100.0F)};
  const PostReader reader = reader_of(raw);
  const HeightPyramid pyramid(raw.columns,
                              raw.rows,
                              std::make_shared<BlockCache>(std::size_t{1} << 20U),
                              [&](int column, int row, int columns, int rows) -> Result<RawPosts> {
                                if (column == 512 && row == 512)
                                  return Error{ErrorCode::kIo, "a damaged block"};
                                return reader(column, row, columns, rows);
                              });
  const HeightErrors all;
  {
    const HeightErrors damaged;
    EXPECT_TRUE(std::isnan(pyramid.filled().bilinear(0, 550.0, 550.0)));
    ASSERT_FALSE(damaged.status());
    EXPECT_EQ(damaged.status().error().message, "a damaged block");
  }
  const HeightErrors whole;
  EXPECT_EQ(pyramid.filled().bilinear(0, 130.0, 5.0), 100.0);
  EXPECT_TRUE(whole.status());
  EXPECT_FALSE(all.status());
}

}  // namespace
}  // namespace overfly::terrain
