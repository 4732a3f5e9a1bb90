#include "flight/logs/index/log_index.hpp"

#include <algorithm>
#include <utility>

namespace overfly::flight::logs {
namespace {

constexpr std::int64_t kMarginNs = 10'000'000'000;

}  // namespace

void LogIndexBuilder::time(const LogTime& time) {
  restarts_ = restarts_ || time.boot > 0;
  block_.first_ns = std::min(block_.first_ns.value_or(time.t_ns), time.t_ns);
  block_.last_ns = std::max(block_.last_ns.value_or(time.t_ns), time.t_ns);
}

void LogIndexBuilder::end_block(std::uint64_t offset) {
  if (offset <= block_.bytes.begin) return;
  block_.bytes.end = offset;
  blocks_.push_back(block_);
  block_ = LogBlock{{offset, offset}, {}, {}, false};
}

std::optional<LogIndex> LogIndexBuilder::finish(std::uint64_t size_bytes) {
  end_block(size_bytes);
  if (restarts_ || blocks_.empty()) return std::nullopt;
  return std::move(blocks_);
}

std::vector<FileRange> parts_for(const LogIndex& index, const LogSlice& slice) {
  // The blocks from the first to the last that the slice touches.
  std::size_t begin = index.size();
  std::size_t end = 0;
  for (std::size_t i = 0; i < index.size(); ++i) {
    const LogBlock& block = index[i];
    if (!block.first_ns) continue;
    const bool after = slice.from_ns && *block.last_ns < *slice.from_ns - kMarginNs;
    const bool before = slice.to_ns && *block.first_ns > *slice.to_ns + kMarginNs;
    if (after || before) continue;
    begin = std::min(begin, i);
    end = i + 1;
  }
  std::vector<FileRange> parts;
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (!index[i].declares && (i < begin || i >= end)) continue;
    if (!parts.empty() && parts.back().end == index[i].bytes.begin) {
      parts.back().end = index[i].bytes.end;
    } else {
      parts.push_back(index[i].bytes);
    }
  }
  return parts;
}

}  // namespace overfly::flight::logs
