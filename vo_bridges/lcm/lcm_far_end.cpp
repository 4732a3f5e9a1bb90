#include "vo_bridges/lcm/lcm_far_end.hpp"

#include <iterator>

namespace overfly {
namespace {

/// Lines that wait to be taken, and messages told of one by one: a flood must not fill memory.
constexpr std::size_t kMostLines = 1000;
constexpr std::int64_t kMostRefusalsTold = 20;
constexpr std::size_t kLongestLine = 2000;

}  // namespace

void LcmFarEnd::hear(const overfly_lcm::status_t& status) {
  const std::lock_guard lock(mutex_);
  session_ = status.session;
  parameters_.clear();
  for (const auto& [name, value] : status.parameters) parameters_[name] = value;
  if (!status.name.empty()) {
    parameters_["estimator"] = status.name + (status.version.empty() ? "" : " " + status.version);
  }
  if (status.cpu_s >= 0.0 && status.peak_memory_mb >= 0.0) {
    resource_use_ = ResourceUse{status.cpu_s, status.peak_memory_mb};
  }
  for (const std::string& line : status.lines) add_line(line);
  changed_.notify_all();
}

bool LcmFarEnd::wait_until_ready(std::int64_t session, std::chrono::nanoseconds timeout) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, timeout, [&] { return session_ == session; });
}

void LcmFarEnd::refuse(const std::string& channel, const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (++refused_ <= kMostRefusalsTold) add_line("refused a message of " + channel + ": " + why);
}

std::int64_t LcmFarEnd::refused() const {
  const std::lock_guard lock(mutex_);
  return refused_;
}

void LcmFarEnd::say(const std::string& line) {
  const std::lock_guard lock(mutex_);
  add_line(line);
}

void LcmFarEnd::add_line(const std::string& line) {
  log_.push_back(line.substr(0, kLongestLine));
  if (log_.size() > kMostLines) log_.pop_front();
}

std::vector<std::string> LcmFarEnd::take_log() {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> lines(std::make_move_iterator(log_.begin()),
                                 std::make_move_iterator(log_.end()));
  log_.clear();
  return lines;
}

std::optional<ResourceUse> LcmFarEnd::resource_use() const {
  const std::lock_guard lock(mutex_);
  return resource_use_;
}

std::map<std::string, std::string> LcmFarEnd::parameters() const {
  const std::lock_guard lock(mutex_);
  return parameters_;
}

}  // namespace overfly
