// Queue of tasks for the drawing thread: the newest task of each client's stream, first come first
// served. Tasks whose world is being opened stand aside.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>

#include "server/views/view_task.hpp"

namespace overfly::server {

/// Not thread-safe: the service guards it.
class ViewQueue {
 public:
  struct Entry {
    std::uint64_t client = 0;
    int stream = 0;
    std::unique_ptr<ViewTask> task;
  };

  /// A stream that waits already keeps its place in the queue and gets the new task.
  /// @return the task replaced; null if there was none
  [[nodiscard]] std::unique_ptr<ViewTask> push(Entry entry) {
    for (std::deque<Entry>* waiting : {&entries_, &aside_}) {
      for (Entry& other : *waiting) {
        if (!same_stream(other, entry)) continue;
        std::swap(other, entry);
        return std::move(entry.task);
      }
    }
    entries_.push_back(std::move(entry));
    return nullptr;
  }

  /// Puts an entry that was popped aside until release().
  /// @return its task if a newer one of its stream waits, else null
  [[nodiscard]] std::unique_ptr<ViewTask> stand_aside(Entry entry) {
    for (const Entry& other : entries_) {
      if (same_stream(other, entry)) return std::move(entry.task);
    }
    aside_.push_back(std::move(entry));
    return nullptr;
  }

  /// Puts the entries that stand aside back into the queue.
  void release() {
    for (Entry& entry : aside_) entries_.push_back(std::move(entry));
    aside_.clear();
  }

  [[nodiscard]] std::optional<Entry> pop() {
    if (entries_.empty()) return std::nullopt;
    Entry entry = std::move(entries_.front());
    entries_.pop_front();
    return entry;
  }

  void forget(std::uint64_t client) {
    const auto is_clients = [&](const Entry& entry) { return entry.client == client; };
    std::erase_if(entries_, is_clients);
    std::erase_if(aside_, is_clients);
  }

  /// True if there is nothing to pop.
  [[nodiscard]] bool empty() const { return entries_.empty(); }

 private:
  static bool same_stream(const Entry& a, const Entry& b) {
    return a.client == b.client && a.stream == b.stream;
  }

  std::deque<Entry> entries_;
  std::deque<Entry> aside_;
};

}  // namespace overfly::server
