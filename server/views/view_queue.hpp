// Queue of picture requests: the newest request of each client's stream, first come first served.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "server/views/picture_request.hpp"

namespace overfly::server {

/// Not thread-safe: the service guards it.
class ViewQueue {
 public:
  struct Entry {
    std::uint64_t client = 0;
    int stream = 0;
    PictureRequest request;
    PictureDone done;
  };

  /// A stream that waits already keeps its place in the queue and gets the new request.
  /// @return the `done` of the request replaced, empty if there was none
  [[nodiscard]] PictureDone push(Entry entry) {
    for (Entry& waiting : entries_) {
      if (waiting.client != entry.client || waiting.stream != entry.stream) continue;
      std::swap(waiting, entry);
      return std::move(entry.done);
    }
    entries_.push_back(std::move(entry));
    return {};
  }

  [[nodiscard]] std::optional<Entry> pop() {
    if (entries_.empty()) return std::nullopt;
    Entry entry = std::move(entries_.front());
    entries_.pop_front();
    return entry;
  }

  void forget(std::uint64_t client) {
    std::erase_if(entries_, [&](const Entry& entry) { return entry.client == client; });
  }

  [[nodiscard]] bool empty() const { return entries_.empty(); }

 private:
  std::deque<Entry> entries_;
};

}  // namespace overfly::server
