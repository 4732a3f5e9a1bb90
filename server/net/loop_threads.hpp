// Threads that run an event loop.
#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "core/result.hpp"

namespace overfly::net {

/// What a handler throws ends that handler alone: it is reported, and its thread goes on.
class LoopThreads {
 public:
  /// @param report  called from the loop's threads with what a handler threw; must not throw
  explicit LoopThreads(std::function<void(const std::string&)> report)
      : report_(std::move(report)) {}
  ~LoopThreads() { stop(); }
  LoopThreads(const LoopThreads&) = delete;
  LoopThreads& operator=(const LoopThreads&) = delete;

  [[nodiscard]] boost::asio::io_context& loop() { return loop_; }
  /// Errors: kInternal when the system starts no further thread; those that were started have ended
  /// then.
  /// @param begin  what each thread does first
  [[nodiscard]] Status start(int threads, const std::function<void()>& begin = {});
  /// Ends the loop and joins its threads; handlers not begun are dropped.
  void stop();

 private:
  void run() noexcept;

  std::function<void(const std::string&)> report_;
  boost::asio::io_context loop_;
  /// The loop goes on while it has nothing to do.
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{
      loop_.get_executor()};
  std::vector<std::thread> threads_;
};

}  // namespace overfly::net
