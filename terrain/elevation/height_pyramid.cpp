#include "terrain/elevation/height_pyramid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "terrain/elevation/steep_steps.hpp"
#include "terrain/height_errors.hpp"

namespace overfly::terrain {
namespace {

/// Maximum number of posts of the levels kept in memory (16 MB with their coarser levels).
constexpr double kKeptPosts = 3e6;

int blocks(int posts) { return (posts + kBlockPosts - 1) / kBlockPosts; }

}  // namespace

std::size_t HeightPyramid::Hash::operator()(const BlockKey& key) const {
  const auto column = static_cast<std::uint64_t>(key.column);
  const auto row = static_cast<std::uint64_t>(key.row);
  return ((column * 0x9e3779b97f4a7c15U) ^ (row * 0xbf58476d1ce4e5b9U)) +
         static_cast<std::size_t>(key.level);
}

HeightPyramid::HeightPyramid(int columns,
                             int rows,
                             std::shared_ptr<BlockCache> cache,
                             PostReader reader)
    : columns_(columns),
      rows_(rows),
      raw_owner_(new_block_owner()),
      cache_(cache),
      reader_(std::move(reader)),
      filled_(columns, rows, std::move(cache), [this](int level, int column, int row) {
        return block(level, column, row);
      }) {
  while (static_cast<double>(filled_.columns(kept_from_level_)) * filled_.rows(kept_from_level_) >
         kKeptPosts) {
    ++kept_from_level_;
  }
}

HeightGrid HeightPyramid::empty_block(int level, int column, int row) const {
  HeightGrid grid;
  grid.columns = std::min(kBlockPosts, filled_.columns(level) - column * kBlockPosts);
  grid.rows = std::min(kBlockPosts, filled_.rows(level) - row * kBlockPosts);
  grid.heights_m.assign(static_cast<std::size_t>(grid.columns) * grid.rows,
                        std::numeric_limits<float>::quiet_NaN());
  return grid;
}

void HeightPyramid::keep(int level, int column, int row, HeightGrid block) {
  if (level + 1 < filled_.levels()) {
    const BlockKey above{raw_owner_, level + 1, column / 2, row / 2};
    auto [place, added] = pending_.try_emplace(above);
    Pending& pending = place->second;
    if (added) {
      pending.grid = empty_block(level + 1, above.column, above.row);
      const int across = std::min(2, blocks(filled_.columns(level)) - 2 * above.column);
      const int down = std::min(2, blocks(filled_.rows(level)) - 2 * above.row);
      pending.missing = across * down;
    }
    constexpr int kHalf = kBlockPosts / 2;
    halve_into(block, (column % 2) * kHalf, (row % 2) * kHalf, pending.grid);
    if (--pending.missing == 0) {
      HeightGrid whole = std::move(pending.grid);
      pending_.erase(place);
      keep(level + 1, above.column, above.row, std::move(whole));
    }
  }
  if (level < kept_from_level_) return;
  kept_[{raw_owner_, level, column, row}] = std::make_shared<const HeightGrid>(std::move(block));
}

Result<HeightSurvey> HeightPyramid::survey(const std::function<bool()>& cancelled, double steep_m) {
  HeightSurvey survey;
  SteepSteps steps(columns_, steep_m);
  survey.lowest_m = std::numeric_limits<double>::max();
  survey.highest_m = std::numeric_limits<double>::lowest();
  for (int row = 0; row < blocks(rows_); ++row) {
    for (int column = 0; column < blocks(columns_); ++column) {
      if (cancelled && cancelled()) {
        return Error{ErrorCode::kCancelled, "reading the elevation was cancelled"};
      }
      const HeightGrid shape = empty_block(0, column, row);
      auto read = reader_(column * kBlockPosts, row * kBlockPosts, shape.columns, shape.rows);
      if (!read) return read.error();
      survey.implausible += static_cast<double>(read->implausible);
      survey.posts += static_cast<double>(read->grid.heights_m.size() - read->outside);
      survey.voids -= static_cast<double>(read->outside);
      for (const float height : read->grid.heights_m) {
        if (std::isnan(height)) {
          ++survey.voids;
          continue;
        }
        survey.lowest_m = std::min<double>(survey.lowest_m, height);
        survey.highest_m = std::max<double>(survey.highest_m, height);
      }
      steps.add(column * kBlockPosts, read->grid);
      keep(0, column, row, std::move(read->grid));
    }
  }
  survey.steep = steps.count();
  survey.steepest_m = steps.largest_m();
  return survey;
}

Result<BlockPtr> HeightPyramid::raw(int level, int column, int row) const {
  const BlockKey key{raw_owner_, level, column, row};
  if (const auto kept = kept_.find(key); kept != kept_.end()) return kept->second;
  if (BlockPtr found = cache_->find(key)) return found;
  HeightGrid grid = empty_block(level, column, row);
  if (level == 0) {
    auto read = reader_(column * kBlockPosts, row * kBlockPosts, grid.columns, grid.rows);
    if (!read) return read.error();
    grid = std::move(read->grid);
  } else {
    for (int v = 2 * row; v < std::min(2 * row + 2, blocks(filled_.rows(level - 1))); ++v) {
      for (int u = 2 * column; u < std::min(2 * column + 2, blocks(filled_.columns(level - 1)));
           ++u) {
        auto quarter = raw(level - 1, u, v);
        if (!quarter) return quarter.error();
        constexpr int kHalf = kBlockPosts / 2;
        halve_into(**quarter, (u % 2) * kHalf, (v % 2) * kHalf, grid);
      }
    }
  }
  auto block = std::make_shared<const HeightGrid>(std::move(grid));
  cache_->put(key, block);
  return BlockPtr(block);
}

Result<HeightGrid> HeightPyramid::unfilled(int level, int column, int row) const {
  const int left = column * kBlockPosts;
  const int top = row * kBlockPosts;
  const int width = std::min(kBlockPosts + 1, filled_.columns(level) - left);
  const int height = std::min(kBlockPosts + 1, filled_.rows(level) - top);
  HeightGrid read;
  if (level == 0) {
    auto posts = reader_(left, top, width, height);
    if (!posts) return posts.error();
    if (width > kBlockPosts && height > kBlockPosts) return std::move(posts->grid);
    read = std::move(posts->grid);
  }
  HeightGrid result;
  result.columns = kBlockPosts + 1;
  result.rows = kBlockPosts + 1;
  result.heights_m.resize(static_cast<std::size_t>(result.columns) * result.rows);
  // The block and its neighbours to the east and south, for their first column and row.
  BlockPtr raws[2][2];
  for (int j = 0; j < result.rows; ++j) {
    const int y = std::min(j, height - 1);
    for (int i = 0; i < result.columns; ++i) {
      const int x = std::min(i, width - 1);
      if (level == 0) {
        result.at(i, j) = read.at(x, y);
        continue;
      }
      BlockPtr& from = raws[y / kBlockPosts][x / kBlockPosts];
      if (!from) {
        auto block = raw(level, column + x / kBlockPosts, row + y / kBlockPosts);
        if (!block) return block.error();
        from = std::move(*block);
      }
      result.at(i, j) = from->at(x % kBlockPosts, y % kBlockPosts);
    }
  }
  return result;
}

Result<HeightGrid> HeightPyramid::block(int level, int column, int row) const {
  auto result = unfilled(level, column, row);
  if (!result || level + 1 >= filled_.levels()) return result;
  const HeightErrors errors;
  const int last_column = filled_.columns(level) - 1;
  const int last_row = filled_.rows(level) - 1;
  for (int j = 0; j < result->rows; ++j) {
    const int y = std::min(row * kBlockPosts + j, last_row);
    for (int i = 0; i < result->columns; ++i) {
      float& height = result->at(i, j);
      if (!std::isnan(height)) continue;
      const int x = std::min(column * kBlockPosts + i, last_column);
      height = static_cast<float>(filled_.bilinear(level + 1, 0.5 * x - 0.25, 0.5 * y - 0.25));
    }
  }
  if (Status read = errors.status(); !read) return read.error();
  return result;
}

}  // namespace overfly::terrain
