// Messages that wait until the clock that stamps them is proven.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "flight/logs/boot_clock.hpp"

namespace overfly::flight::logs {

/// If a clock is not proven by then, it is believed.
inline constexpr std::size_t kMostHeld = 64;

/// The messages of a clock's unproven stamps, in their order. At most kMostHeld are held: if the
/// clock is not proven by then, they are passed on as they are.
template <typename Message>
class HeldMessages {
 public:
  /// Whether the message of the stamp that the clock took last must be held.
  [[nodiscard]] bool must_hold(const BootClock& clock) const {
    return !clock.proven() && clock.latest() && held_.size() < kMostHeld;
  }
  void hold(const std::optional<LogTime>& time, Message message) {
    held_.emplace_back(time, std::move(message));
  }
  /// Passes on what is held: without times that were wrong.
  /// @param pass  takes the time and the message
  template <typename Pass>
  void release(const BootClock& clock, const Pass& pass) {
    if (held_.empty()) return;
    const std::vector<std::pair<std::optional<LogTime>, Message>> held = std::exchange(held_, {});
    for (const auto& [time, message] : held) {
      pass(time && clock.was_wrong(*time) ? std::nullopt : time, message);
    }
  }

 private:
  std::vector<std::pair<std::optional<LogTime>, Message>> held_;
};

}  // namespace overfly::flight::logs
