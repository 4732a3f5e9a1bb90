#include "server/record/rows/sensor_index.hpp"

#include <algorithm>

namespace overfly::server {
namespace {

/// Whether a file may only have grown since.
bool is_continued(const SensorFileIndex& index, const FileStamp& now) {
  const FileStamp& before = index.stamp;
  const bool grown = now.size_bytes > before.size_bytes;
  const bool unchanged =
      now.size_bytes == before.size_bytes && now.modified_ns == before.modified_ns;
  return now.exists && now.inode == before.inode && (grown || unchanged) &&
         now.size_bytes >= static_cast<std::int64_t>(index.end().offset);
}

}  // namespace

void SensorFileIndex::start(const RowPlace& first_row) {
  blocks_.clear();
  end_ = first_row;
}

void SensorFileIndex::add(std::int64_t t_ns, const RowPlace& next) {
  const bool is_full =
      blocks_.empty() || blocks_.back().end - blocks_.back().begin.offset >= block_bytes_;
  if (is_full) {
    if (blocks_.size() == kMaxBlocks) merge_pairs();
    blocks_.push_back({end_, next.offset, t_ns, t_ns});
  } else {
    SensorBlock& block = blocks_.back();
    block.end = next.offset;
    block.first_ns = std::min(block.first_ns, t_ns);
    block.last_ns = std::max(block.last_ns, t_ns);
  }
  end_ = next;
}

void SensorFileIndex::merge_pairs() {
  static_assert(kMaxBlocks % 2 == 0);
  for (std::size_t i = 0; i < blocks_.size() / 2; ++i) {
    const SensorBlock& a = blocks_[2 * i];
    const SensorBlock& b = blocks_[2 * i + 1];
    blocks_[i] = {a.begin, b.end, std::min(a.first_ns, b.first_ns), std::max(a.last_ns, b.last_ns)};
  }
  blocks_.resize(blocks_.size() / 2);
  block_bytes_ *= 2;
}

std::vector<SensorBlock> SensorFileIndex::stretches(std::int64_t from_ns,
                                                    std::int64_t to_ns) const {
  std::vector<SensorBlock> stretches;
  for (const SensorBlock& block : blocks_) {
    if (block.last_ns < from_ns || block.first_ns > to_ns) continue;
    if (!stretches.empty() && stretches.back().end == block.begin.offset) {
      SensorBlock& last = stretches.back();
      last.end = block.end;
      last.first_ns = std::min(last.first_ns, block.first_ns);
      last.last_ns = std::max(last.last_ns, block.last_ns);
    } else {
      stretches.push_back(block);
    }
  }
  return stretches;
}

SensorFileIndex SensorIndex::of(std::size_t file, const FileStamp& stamp) const {
  const std::lock_guard lock(mutex_);
  return is_continued(files_[file], stamp) ? files_[file] : SensorFileIndex();
}

void SensorIndex::keep(std::size_t file, SensorFileIndex index) {
  const std::lock_guard lock(mutex_);
  SensorFileIndex& present = files_[file];
  const bool is_same = present.stamp.inode == index.stamp.inode &&
                       present.stamp.modified_ns == index.stamp.modified_ns;
  if (!is_same || index.end().offset > present.end().offset) present = std::move(index);
}

std::shared_ptr<SensorIndex> SensorIndexShelf::of(const std::filesystem::path& run_folder) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(runs_.begin(), runs_.end(), [&](const auto& run) {
    return run.first == run_folder.string();
  });
  if (found != runs_.end()) {
    runs_.splice(runs_.begin(), runs_, found);
  } else {
    runs_.emplace_front(run_folder.string(), std::make_shared<SensorIndex>());
    if (runs_.size() > kMaxRuns) runs_.pop_back();
  }
  return runs_.front().second;
}

}  // namespace overfly::server
