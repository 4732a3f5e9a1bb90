#include "server/net/foxglove/due_rows.hpp"

#include <utility>

#include "server/timeline/count_frames.hpp"

namespace overfly::net::foxglove {
namespace {

/// Rows of one source read at once.
constexpr std::size_t kBatchRows = 64;

DueRow due(server::FrameRow row, std::size_t camera) { return {row.t_ns, camera, std::move(row)}; }
DueRow due(server::EstimateRow row, std::size_t estimator) {
  return {row.sample.t_ns, estimator, std::move(row)};
}
DueRow due(server::LogRow row, std::size_t /*index*/) { return {row.t_ns, 0, std::move(row)}; }

template <typename Row>
std::vector<DueRow> due_rows(std::vector<Row> rows, std::size_t index) {
  std::vector<DueRow> list;
  list.reserve(rows.size());
  for (Row& row : rows) list.push_back(due(std::move(row), index));
  return list;
}

}  // namespace

DueRows::DueRows(std::shared_ptr<const server::RunTimeline> timeline)
    : timeline_(std::move(timeline)) {
  for (std::size_t i = 0; i < timeline_->cameras().size(); ++i) {
    sources_.push_back({Kind::kFrames, i, 0, {}});
  }
  for (std::size_t i = 0; i < timeline_->estimators().size(); ++i) {
    sources_.push_back({Kind::kEstimates, i, 0, {}});
  }
  sources_.push_back({Kind::kLog, 0, 0, {}});
}

std::vector<DueRow> DueRows::read(const Source& source,
                                  std::size_t first,
                                  std::size_t limit) const {
  switch (source.kind) {
    case Kind::kFrames:
      return due_rows(timeline_->frames(first, limit, source.index), source.index);
    case Kind::kEstimates:
      return due_rows(timeline_->estimates(source.index, first, limit), source.index);
    case Kind::kLog:
      break;
  }
  return due_rows(timeline_->logs(first, limit), 0);
}

std::size_t DueRows::count(const Source& source) const {
  switch (source.kind) {
    case Kind::kFrames:
      return timeline_->frame_count(source.index);
    case Kind::kEstimates:
      return timeline_->estimate_count(source.index);
    case Kind::kLog:
      break;
  }
  return timeline_->log_count();
}

std::optional<DueRow> DueRows::next(std::int64_t t_ns) {
  Source* first = nullptr;
  for (Source& source : sources_) {
    if (source.waiting.empty()) {
      for (DueRow& row : read(source, source.next_row, kBatchRows)) {
        source.waiting.push_back(std::move(row));
        ++source.next_row;
      }
    }
    if (source.waiting.empty() || source.waiting.front().t_ns > t_ns) continue;
    if (first == nullptr || source.waiting.front().t_ns < first->waiting.front().t_ns) {
      first = &source;
    }
  }
  if (first == nullptr) return std::nullopt;
  DueRow row = std::move(first->waiting.front());
  first->waiting.pop_front();
  return row;
}

void DueRows::jump_to(std::int64_t t_ns) {
  for (Source& source : sources_) {
    source.waiting.clear();
    source.next_row = server::count_rows(count(source), [&](std::size_t i) {
      const auto row = read(source, i, 1);
      return !row.empty() && row.front().t_ns <= t_ns;
    });
  }
}

}  // namespace overfly::net::foxglove
