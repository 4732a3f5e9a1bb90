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

/// An exception in a handler ends only that handler: it is reported, and the thread continues.
class LoopThreads {
 public:
  /// @param report  called on the loop's threads with the text of a handler's exception; must not
  ///                throw
  explicit LoopThreads(std::function<void(const std::string&)> report)
      : report_(std::move(report)) {}
  ~LoopThreads() { stop(); }
  LoopThreads(const LoopThreads&) = delete;
  LoopThreads& operator=(const LoopThreads&) = delete;

  [[nodiscard]] boost::asio::io_context& loop() { return loop_; }
  /// Errors: kInternal if the system cannot start a thread; the threads already started have ended
  /// then.
  /// @param begin  called first on each thread
  [[nodiscard]] Status start(int threads, const std::function<void()>& begin = {});
  /// Stops the loop and joins its threads; handlers not yet begun are dropped.
  void stop();

 private:
  void run() noexcept;

  std::function<void(const std::string&)> report_;
  boost::asio::io_context loop_;
  /// Keeps the loop running while it has nothing to do.
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{
      loop_.get_executor()};
  std::vector<std::thread> threads_;
};

}  // namespace overfly::net
