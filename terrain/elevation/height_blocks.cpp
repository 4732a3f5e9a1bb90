#include "terrain/elevation/height_blocks.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>

#include "terrain/height_errors.hpp"

namespace overfly::terrain {
namespace {

std::size_t bytes_of(const HeightGrid& grid) { return sizeof(float) * grid.heights_m.size() + 256; }

/// Interpolates two posts; the NaN of a post with weight 0 must not propagate.
double blend(double a, double b, double share) {
  if (share == 0.0) return a;
  return share == 1.0 ? b : a + share * (b - a);
}

/// The blocks that one thread used recently: enough for a flight's ground queries and a mesh over a
/// few levels.
struct Recent {
  BlockKey key;
  BlockPtr block;
};
constexpr std::size_t kRecent = 128;

std::size_t slot_of(const BlockKey& key) {
  const auto mixed = static_cast<std::uint64_t>(key.column) + 5U * static_cast<unsigned>(key.row) +
                     3U * static_cast<unsigned>(key.level) + key.owner;
  return mixed % kRecent;
}

}  // namespace

std::size_t BlockCache::Hash::operator()(const BlockKey& key) const {
  std::uint64_t h = key.owner * 0x9e3779b97f4a7c15U;
  h = (h ^ static_cast<unsigned>(key.level)) * 0xbf58476d1ce4e5b9U;
  h = (h ^ static_cast<unsigned>(key.column)) * 0x94d049bb133111ebU;
  h = (h ^ static_cast<unsigned>(key.row)) * 0x9e3779b97f4a7c15U;
  return h ^ (h >> 29U);
}

BlockPtr BlockCache::find(const BlockKey& key) {
  const std::lock_guard lock(mutex_);
  const auto found = places_.find(key);
  if (found == places_.end()) return nullptr;
  used_.splice(used_.begin(), used_, found->second);
  return found->second->second;
}

void BlockCache::put(const BlockKey& key, BlockPtr block) {
  const std::lock_guard lock(mutex_);
  if (places_.contains(key)) return;
  bytes_ += bytes_of(*block);
  used_.emplace_front(key, std::move(block));
  places_[key] = used_.begin();
  while (bytes_ > budget_bytes_ && used_.size() > 1) {
    bytes_ -= bytes_of(*used_.back().second);
    places_.erase(used_.back().first);
    used_.pop_back();
  }
}

std::size_t BlockCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::uint64_t new_block_owner() {
  static std::atomic<std::uint64_t> next{1};
  return next++;
}

PagedHeights::PagedHeights(int columns, int rows, std::shared_ptr<BlockCache> cache, Loader loader)
    : owner_(new_block_owner()),
      columns_(columns),
      rows_(rows),
      cache_(std::move(cache)),
      loader_(std::move(loader)) {
  for (int side = std::max(columns, rows); side > 1; side = (side + 1) / 2) ++levels_;
  unreadable_.columns = kBlockPosts + 1;
  unreadable_.rows = kBlockPosts + 1;
  unreadable_.heights_m.assign(static_cast<std::size_t>(unreadable_.columns) * unreadable_.rows,
                               std::numeric_limits<float>::quiet_NaN());
}

int PagedHeights::columns(int level) const { return ((columns_ - 1) >> level) + 1; }

int PagedHeights::rows(int level) const { return ((rows_ - 1) >> level) + 1; }

Result<BlockPtr> PagedHeights::block(int level, int column, int row) const {
  const BlockKey key{owner_, level, column, row};
  if (BlockPtr found = cache_->find(key)) return found;
  auto loaded = loader_(level, column, row);
  if (!loaded) return loaded.error();
  auto block = std::make_shared<const HeightGrid>(std::move(*loaded));
  cache_->put(key, block);
  return BlockPtr(block);
}

const HeightGrid& PagedHeights::near(int level, int column, int row) const {
  thread_local std::array<Recent, kRecent> recent;
  const BlockKey key{owner_, level, column, row};
  Recent& slot = recent[slot_of(key)];
  if (slot.key == key) return *slot.block;
  auto found = block(level, column, row);
  if (!found) {
    HeightErrors::add(found.error());
    const std::lock_guard lock(error_mutex_);
    if (!read_error_) read_error_ = found.error();
    return unreadable_;
  }
  // A loader may have used the same slot meanwhile, so it is accessed by index again.
  slot = {key, std::move(*found)};
  return *slot.block;
}

std::optional<Error> PagedHeights::read_error() const {
  const std::lock_guard lock(error_mutex_);
  return read_error_;
}

double PagedHeights::bilinear(int level, double column, double row) const {
  const int columns = this->columns(level);
  const int rows = this->rows(level);
  const double u = std::clamp(column, 0.0, columns - 1.0);
  const double v = std::clamp(row, 0.0, rows - 1.0);
  const int i = std::min(static_cast<int>(u), std::max(0, columns - 2));
  const int j = std::min(static_cast<int>(v), std::max(0, rows - 2));
  const double s = u - i;
  const double t = v - j;
  const HeightGrid& block = near(level, i / kBlockPosts, j / kBlockPosts);
  const int west = i % kBlockPosts;
  const int north = j % kBlockPosts;
  return blend(blend(block.at(west, north), block.at(west + 1, north), s),
               blend(block.at(west, north + 1), block.at(west + 1, north + 1), s),
               t);
}

}  // namespace overfly::terrain
