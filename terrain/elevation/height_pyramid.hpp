// Inside terrain only: averaged levels of posts with their voids filled, block by block.
//
// Method: push-pull (Gortler et al., The Lumigraph, 1996, sec. 3.4). Post (i, j) of raw level L + 1
// is the mean of those of the posts (2i, 2j) .. (2i + 1, 2j + 1) of raw level L that have data. A
// post without data is interpolated from the filled level above at its own place. Each filled post
// depends only on the file: it does not depend on the block boundaries, the order of reading or the
// memory budget.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <unordered_map>
#include <vector>

#include "terrain/elevation/height_blocks.hpp"

namespace overfly::terrain {

/// A window of posts in metres, NaN where there is no data.
struct RawPosts {
  HeightGrid grid;
  std::size_t implausible = 0;  ///< implausible values, replaced by NaN
  std::size_t outside = 0;      ///< posts of the grid that no file reaches
};

/// Undeclared no-data values found in one layer.
struct UndeclaredVoids {
  double posts = 0.0;
  double of_posts = 0.0;
  std::vector<float> values;  ///< in the layer's own numbers
};

/// Reads the posts [column, column + columns) x [row, row + rows), all within the raster.
using PostReader = std::function<Result<RawPosts>(int column, int row, int columns, int rows)>;

/// Results of reading every post once.
struct HeightSurvey {
  double lowest_m = 0.0;
  double highest_m = 0.0;
  double posts = 0;  ///< without those that no file reaches
  double voids = 0;
  double implausible = 0;
  std::vector<bool> implausible_layers;  ///< for several layers: those with such values
  double steep = 0.0;                    ///< number of implausibly steep steps between neighbours
  double steepest_m = 0.0;               ///< the largest of them
  std::vector<UndeclaredVoids> undeclared;  ///< of each layer
};

/// Thread-safe after `survey`.
class HeightPyramid {
 public:
  HeightPyramid(int columns, int rows, std::shared_ptr<BlockCache> cache, PostReader reader);
  HeightPyramid(const HeightPyramid&) = delete;
  HeightPyramid& operator=(const HeightPyramid&) = delete;

  /// Reads all posts once, row of blocks by row, and keeps the coarse levels. May be called again
  /// if the reader has found no-data values.
  /// @param cancelled  polled before each block; may be empty
  /// @param steep_m  steps between neighbours above this value are counted
  /// Errors: those of the reader; kCancelled.
  Result<HeightSurvey> survey(const std::function<bool()>& cancelled = {},
                              double steep_m = std::numeric_limits<double>::infinity());

  /// Loader of PagedHeights: filled posts. Errors: those of the reader.
  [[nodiscard]] Result<HeightGrid> block(int level, int column, int row) const;
  [[nodiscard]] const PagedHeights& filled() const { return filled_; }

 private:
  struct Pending {
    HeightGrid grid;
    int missing = 0;  ///< quarters not received yet
  };
  struct Hash {
    std::size_t operator()(const BlockKey& key) const;
  };

  [[nodiscard]] HeightGrid empty_block(int level, int column, int row) const;
  [[nodiscard]] Result<BlockPtr> raw(int level, int column, int row) const;
  [[nodiscard]] Result<HeightGrid> unfilled(int level, int column, int row) const;
  void keep(int level, int column, int row, HeightGrid block);

  int columns_;
  int rows_;
  int kept_from_level_ = 0;
  std::uint64_t raw_owner_;
  std::shared_ptr<BlockCache> cache_;
  PostReader reader_;
  PagedHeights filled_;
  std::unordered_map<BlockKey, BlockPtr, Hash> kept_;
  std::unordered_map<BlockKey, Pending, Hash> pending_;
};

}  // namespace overfly::terrain
