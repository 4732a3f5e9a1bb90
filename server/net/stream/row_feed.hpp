// Sends a run's rows to a viewer, each once and in order.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/timeline/run_timeline.hpp"

namespace overfly::net {

class RowFeed {
 public:
  /// Maximum number of rows in one message.
  static constexpr std::size_t kMaxRows = 2000;

  /// Errors: kInvalidArgument naming a stream that the run does not have.
  static Status check_resume(const server::RunTimeline& timeline,
                             const std::map<std::string, std::size_t>& resume);
  /// @param resume  number of rows that the viewer already has, by stream; others start at 0
  RowFeed(std::string run_id,
          std::shared_ptr<const server::RunTimeline> timeline,
          const std::map<std::string, std::size_t>& resume);

  /// The next `rows` message; empty if all rows so far have been sent.
  [[nodiscard]] std::optional<std::string> next();

 private:
  struct Stream {
    enum class Kind { kTruth, kEstimate, kLog, kVehicle };
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

  std::string run_id_;
  std::shared_ptr<const server::RunTimeline> timeline_;
  std::vector<Stream> streams_;
};

}  // namespace overfly::net
