// State of the estimator at the other end of an LCM network, apart from its answers.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <overfly_lcm/status_t.hpp>
#include <string>
#include <vector>

#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// Thread-safe.
class LcmFarEnd {
 public:
  void hear(const overfly_lcm::status_t& status);
  /// Waits up to `timeout` until the estimator reports that it follows a session. @return whether
  /// it does
  [[nodiscard]] bool wait_until_ready(std::int64_t session, std::chrono::nanoseconds timeout);

  /// Counts and logs a message that cannot be decoded.
  void refuse(const std::string& channel, const std::string& why);
  [[nodiscard]] std::int64_t refused() const;
  /// Adds a line from this program to the estimator's log.
  void say(const std::string& line);

  [[nodiscard]] std::vector<std::string> take_log();
  [[nodiscard]] std::optional<ResourceUse> resource_use() const;
  /// Name and version as "estimator", and the parameters that the estimator reported.
  [[nodiscard]] std::map<std::string, std::string> parameters() const;

 private:
  void add_line(const std::string& line);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<std::int64_t> session_;
  std::map<std::string, std::string> parameters_;
  std::optional<ResourceUse> resource_use_;
  std::deque<std::string> log_;
  std::int64_t refused_ = 0;
  std::int64_t bad_names_ = 0;
};

}  // namespace overfly
