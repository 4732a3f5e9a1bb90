#include "vo_bridges/stamped_answers.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace overfly {
namespace {

/// Number of frames that are remembered: half a minute at 31 Hz.
constexpr std::size_t kRemembered = 1000;

/// |a - b| of any two stamps [ns]; as signed numbers the difference could overflow.
std::uint64_t distance_ns(std::int64_t a, std::int64_t b) {
  const auto larger = static_cast<std::uint64_t>(std::max(a, b));
  return larger - static_cast<std::uint64_t>(std::min(a, b));
}

}  // namespace

void StampedAnswers::expect(std::int64_t t_ns) {
  const std::lock_guard lock(mutex_);
  frames_[t_ns] = {};
  if (frames_.size() > kRemembered) frames_.erase(frames_.begin());
}

StampedAnswers::Frames::iterator StampedAnswers::nearest(std::int64_t t_ns) {
  const auto after = frames_.lower_bound(t_ns);
  const auto distance = [&](Frames::iterator frame) { return distance_ns(frame->first, t_ns); };
  auto best = after;
  if (after != frames_.begin()) {
    const auto before = std::prev(after);
    if (best == frames_.end() || distance(before) < distance(best)) best = before;
  }
  const auto tolerance_ns = static_cast<std::uint64_t>(tolerance_ns_);
  return best != frames_.end() && distance(best) <= tolerance_ns ? best : frames_.end();
}

bool StampedAnswers::deliver(std::int64_t t_ns, VoEstimate answer) {
  const std::lock_guard lock(mutex_);
  const auto found = nearest(t_ns);
  if (found == frames_.end()) {
    ++counts_.unknown;
    return false;
  }
  auto& [stamp_ns, frame] = *found;
  if (frame.answered) {
    ++counts_.duplicate;
    return false;
  }
  frame.answered = true;
  if (newest_answered_ns_ && stamp_ns < *newest_answered_ns_) {
    ++counts_.out_of_order;
  } else {
    newest_answered_ns_ = stamp_ns;
  }
  if (frame.given_up) {
    ++counts_.late;
    return false;
  }
  ++counts_.answered;
  frame.answer = std::move(answer);
  changed_.notify_all();
  return true;
}

std::optional<VoEstimate> StampedAnswers::wait(std::int64_t t_ns,
                                               std::chrono::nanoseconds timeout) {
  std::unique_lock lock(mutex_);
  const auto awaited = [&] {
    const auto found = frames_.find(t_ns);
    return found != frames_.end() && !found->second.given_up &&
           (found->second.answer.has_value() || !found->second.answered);
  };
  const auto settled = [&] {
    return stopped_ || !awaited() || frames_.find(t_ns)->second.answer.has_value();
  };
  changed_.wait_for(lock, timeout, settled);
  if (!awaited()) return std::nullopt;
  return std::exchange(frames_.find(t_ns)->second.answer, std::nullopt);
}

void StampedAnswers::give_up(std::int64_t t_ns) {
  const std::lock_guard lock(mutex_);
  const auto found = frames_.find(t_ns);
  if (found == frames_.end() || found->second.answered || found->second.given_up) return;
  found->second.given_up = true;
  ++counts_.unanswered;
  changed_.notify_all();
}

std::optional<VoEstimate> StampedAnswers::take(std::int64_t t_ns,
                                               std::chrono::nanoseconds timeout) {
  std::optional<VoEstimate> answer = wait(t_ns, timeout);
  if (answer) return answer;
  give_up(t_ns);
  // An answer that arrived between the two lines still counts.
  return wait(t_ns, std::chrono::nanoseconds(0));
}

void StampedAnswers::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

bool StampedAnswers::stopped() const {
  const std::lock_guard lock(mutex_);
  return stopped_;
}

AnswerCounts StampedAnswers::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace overfly
