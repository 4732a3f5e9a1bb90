// Gathers the figures of one stream, message by message.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "flight/logs/flight_log.hpp"

namespace overfly::flight::logs {

/// The distance between two positions if it is a jump: more than 20 m and 150 m/s. 0: it is none.
[[nodiscard]] double jump_between_m(PositionKind kind,
                                    const Eigen::Vector3d& from,
                                    const Eigen::Vector3d& to,
                                    std::int64_t interval_ns);

class StreamStatistics {
 public:
  explicit StreamStatistics(StreamDescription description);

  [[nodiscard]] const StreamDescription& description() const { return info_.description; }
  void message(const std::optional<LogTime>& time);
  void position(const LogTime& time, const Eigen::Vector3d& value);
  void attitude() { ++info_.attitudes; }
  void invalid() { ++info_.invalid; }
  void wrong_value(const LogTime& time, const WrongValue& value);
  void local_origin(const LocalOrigin& origin) {
    info_.georeferenced = true;
    if (!info_.first_origin) info_.first_origin = origin;
  }

  [[nodiscard]] StreamInfo info() const;

 private:
  struct Span {
    std::int64_t first_ns = 0;
    std::int64_t last_ns = 0;
    std::uint64_t messages = 0;
  };
  /// Finds gaps: intervals that are far longer than the mean of those before them.
  class GapFinder {
   public:
    /// @return whether it is a gap
    bool take(std::int64_t interval_ns);
    [[nodiscard]] std::uint64_t intervals() const { return intervals_; }
    [[nodiscard]] double sum_s() const { return sum_s_; }

   private:
    std::uint64_t intervals_ = 0;
    double sum_s_ = 0.0;
  };

  StreamInfo info_;
  std::optional<LogTime> last_;
  Span boot_;          ///< the boot that is being read
  Span longest_boot_;  ///< the earlier boot with the most messages
  GapFinder message_gaps_;
  GapFinder position_gaps_;
  std::optional<Eigen::Vector3d> first_position_;
  LogTime position_time_;  ///< of last_position_
  Eigen::Vector3d last_position_ = Eigen::Vector3d::Zero();
};

}  // namespace overfly::flight::logs
