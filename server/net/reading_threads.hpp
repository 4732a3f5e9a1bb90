// Threads that read for clients: flight logs, worlds.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/net/loop_threads.hpp"

namespace overfly::net {

/// Does at most kParallel pieces of work at a time. Thread-safe.
class ReadingThreads {
 public:
  static constexpr int kParallel = 2;
  static constexpr std::size_t kMaxWaiting = 32;
  using Cancel = std::shared_ptr<std::atomic<bool>>;

  /// @param report  as LoopThreads
  explicit ReadingThreads(std::function<void(const std::string&)> report)
      : threads_(std::move(report)) {}
  ~ReadingThreads() { stop(); }
  ReadingThreads(const ReadingThreads&) = delete;
  ReadingThreads& operator=(const ReadingThreads&) = delete;

  /// Errors: as LoopThreads::start.
  [[nodiscard]] Status start(const std::function<void()>& begin) {
    return threads_.start(kParallel, begin);
  }
  /// @param cancel  true makes the work end early; may be null
  /// @return false if kMaxWaiting pieces of work are waiting or in progress
  [[nodiscard]] bool take(std::function<void()> work, const Cancel& cancel);
  /// Cancels the work in progress; that not yet begun is dropped.
  void stop();

 private:
  std::mutex mutex_;
  std::vector<std::weak_ptr<std::atomic<bool>>> cancels_;
  std::atomic<std::size_t> waiting_{0};
  LoopThreads threads_;
};

}  // namespace overfly::net
