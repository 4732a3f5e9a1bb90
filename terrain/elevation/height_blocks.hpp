// Inside terrain only: heights in square blocks that are read on demand and evicted when the memory
// budget is exceeded.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>

#include "core/result.hpp"
#include "terrain/elevation/height_grid.hpp"

namespace overfly::terrain {

/// Posts per side of a block. A block also holds the first row and column of its neighbours to the
/// south and east, so that interpolation within it needs no other block.
inline constexpr int kBlockPosts = 64;

struct BlockKey {
  std::uint64_t owner = 0;
  int level = 0;
  int column = 0;
  int row = 0;
  bool operator==(const BlockKey&) const = default;
};

using BlockPtr = std::shared_ptr<const HeightGrid>;

/// A cache of the most recently used blocks of all owners, within a budget. Thread-safe.
class BlockCache {
 public:
  explicit BlockCache(std::size_t budget_bytes) : budget_bytes_(budget_bytes) {}
  [[nodiscard]] BlockPtr find(const BlockKey& key);
  void put(const BlockKey& key, BlockPtr block);
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Hash {
    std::size_t operator()(const BlockKey& key) const;
  };
  using Entry = std::pair<BlockKey, BlockPtr>;
  mutable std::mutex mutex_;
  std::size_t budget_bytes_;
  std::size_t bytes_ = 0;
  std::list<Entry> used_;  ///< most recent first
  std::unordered_map<BlockKey, std::list<Entry>::iterator, Hash> places_;
};

/// A unique number for an owner of blocks in this process.
[[nodiscard]] std::uint64_t new_block_owner();

/// A pyramid of posts; those of level L are about 2^L times as far apart as those of level 0.
/// Thread-safe; a look-up in a block that this thread used recently takes no lock.
class PagedHeights {
 public:
  /// Makes a block of (kBlockPosts + 1)^2 posts; beyond the pyramid's edge they repeat it.
  using Loader = std::function<Result<HeightGrid>(int level, int column, int row)>;

  PagedHeights(int columns, int rows, std::shared_ptr<BlockCache> cache, Loader loader);

  /// Bilinear between the posts of a level (post centres at integers of that level); outside, the
  /// edge's value. NaN if a contributing post is NaN or could not be read (see HeightErrors).
  [[nodiscard]] double bilinear(int level, double column, double row) const;
  /// The block itself. Errors: those of the loader.
  [[nodiscard]] Result<BlockPtr> block(int level, int column, int row) const;

  /// The first read error of a block on any thread, if there was one.
  [[nodiscard]] std::optional<Error> read_error() const;

  [[nodiscard]] int columns(int level) const;
  [[nodiscard]] int rows(int level) const;
  /// Level `levels() - 1` has a single post.
  [[nodiscard]] int levels() const { return levels_; }

 private:
  [[nodiscard]] const HeightGrid& near(int level, int column, int row) const;

  std::uint64_t owner_;
  int columns_;
  int rows_;
  int levels_ = 1;
  std::shared_ptr<BlockCache> cache_;
  Loader loader_;
  HeightGrid unreadable_;
  mutable std::mutex error_mutex_;
  mutable std::optional<Error> read_error_;
};

}  // namespace overfly::terrain
