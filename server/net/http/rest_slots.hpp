// Places for requests that take a reading thread for long, which other viewers need too.
#pragma once

#include <atomic>
#include <memory>
#include <utility>

namespace overfly::net {

/// A place that is taken until it is released, at the latest by its destructor.
class Slot {
 public:
  /// @param taken  counts the places that are taken, this one too
  explicit Slot(std::shared_ptr<std::atomic<int>> taken) : taken_(std::move(taken)) {}
  ~Slot() { release(); }
  Slot(const Slot&) = delete;
  Slot& operator=(const Slot&) = delete;
  /// Before the answer is sent: the client's next request may come at once.
  void release() {
    if (!released_.exchange(true)) taken_->fetch_sub(1);
  }

 private:
  std::shared_ptr<std::atomic<int>> taken_;
  std::atomic<bool> released_{false};
};

/// One of `most` places; null if all are taken.
[[nodiscard]] inline std::shared_ptr<Slot> take_slot(const std::shared_ptr<std::atomic<int>>& taken,
                                                     int most) {
  if (taken->fetch_add(1) < most) return std::make_shared<Slot>(taken);
  taken->fetch_sub(1);
  return nullptr;
}

}  // namespace overfly::net
