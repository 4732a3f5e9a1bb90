// The rows of a run in the order of their times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "server/timeline/run_timeline.hpp"

namespace overfly::net::foxglove {

struct DueRow {
  std::int64_t t_ns = 0;
  std::size_t index = 0;  ///< of the camera or the estimator
  std::variant<server::FrameRow, server::EstimateRow, server::LogRow> row;
};

class DueRows {
 public:
  explicit DueRows(std::shared_ptr<const server::RunTimeline> timeline);

  /// The next row that is stamped at or before t; empty if there is none (yet). In the order of
  /// time, but a row that is recorded late (an estimator's answer) comes when it is there.
  [[nodiscard]] std::optional<DueRow> next(std::int64_t t_ns);
  /// Leaves out what is stamped at or before t and was not taken yet, and goes on behind it.
  void jump_to(std::int64_t t_ns);

 private:
  enum class Kind { kFrames, kEstimates, kLog };
  struct Source {
    Kind kind = Kind::kFrames;
    std::size_t index = 0;
    std::size_t next_row = 0;    ///< behind the rows that wait
    std::deque<DueRow> waiting;  ///< read, not taken
  };
  [[nodiscard]] std::vector<DueRow> read(const Source& source,
                                         std::size_t first,
                                         std::size_t limit) const;
  [[nodiscard]] std::size_t count(const Source& source) const;

  std::shared_ptr<const server::RunTimeline> timeline_;
  std::vector<Source> sources_;
};

}  // namespace overfly::net::foxglove
