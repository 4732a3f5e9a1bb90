// Tells a viewer the rows of a run, each once and in order.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/record/run_timeline.hpp"

namespace overfly::net {

class RowFeed {
 public:
  /// Rows of one message at most.
  static constexpr std::size_t kMaxRows = 2000;

  /// @param resume  rows that the viewer already has, by stream; the others start at 0
  RowFeed(std::shared_ptr<const engine::RunTimeline> timeline,
          const std::map<std::string, std::size_t>& resume);

  /// The next `rows` message; empty when all rows so far are told.
  [[nodiscard]] std::optional<std::string> next();

 private:
  struct Stream {
    enum class Kind { kTruth, kEstimate, kLog };
    std::string name;
    Kind kind;
    std::size_t estimator;
    std::size_t next_row;
  };
  void add(const std::string& name,
           Stream::Kind kind,
           std::size_t estimator,
           const std::map<std::string, std::size_t>& resume);
  std::optional<std::string> next_of(Stream* stream);

  std::shared_ptr<const engine::RunTimeline> timeline_;
  std::vector<Stream> streams_;
};

}  // namespace overfly::net
