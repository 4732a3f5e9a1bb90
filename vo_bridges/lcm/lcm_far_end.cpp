#include "vo_bridges/lcm/lcm_far_end.hpp"

#include <cmath>
#include <iterator>

#include "vo_bridges/estimator_text.hpp"

namespace overfly {
namespace {

/// Limits for pending lines and individually reported messages, so that memory stays bounded.
constexpr std::size_t kMostLines = 1000;
constexpr std::int64_t kMostRefusalsTold = 20;
constexpr std::size_t kLongestLine = 2000;

}  // namespace

void LcmFarEnd::hear(const overfly_lcm::status_t& status) {
  const std::lock_guard lock(mutex_);
  session_ = status.session;
  parameters_.clear();
  for (const auto& [name, value] : status.parameters) {
    if (is_figure_name(name)) {
      parameters_[name] = printable(value, kLongestLine);
    } else if (++bad_names_ <= kMostRefusalsTold) {
      add_line("parameter \"" + printable(name, kNameLimitBytes) +
               "\" ignored: its name must be 1 to " + std::to_string(kNameLimitBytes) +
               " printable ASCII characters without spaces");
    }
  }
  if (!status.name.empty()) {
    std::string& estimator = parameters_["estimator"];
    estimator = printable(status.name, kNameLimitBytes);
    if (!status.version.empty()) estimator += ' ' + printable(status.version, kNameLimitBytes);
  }
  const bool finite = std::isfinite(status.cpu_s) && std::isfinite(status.peak_memory_mb);
  if (finite && status.cpu_s >= 0.0 && status.peak_memory_mb >= 0.0) {
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
  const std::size_t end = line.find_last_not_of("\r\n") + 1;
  log_.push_back(printable(line.substr(0, end), kLongestLine));
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
