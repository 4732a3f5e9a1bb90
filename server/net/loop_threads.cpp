#include "server/net/loop_threads.hpp"

#include <exception>

#include "core/barrier.hpp"

namespace overfly::net {

Status LoopThreads::start(int threads, const std::function<void()>& begin) {
  try {
    for (int i = 0; i < threads; ++i) {
      threads_.emplace_back([this, begin] {
        if (begin) begin();
        run();
      });
    }
  } catch (const std::exception& error) {
    const std::string started = std::to_string(threads_.size());
    stop();
    return Error{ErrorCode::kInternal,
                 "only " + started + " of " + std::to_string(threads) +
                     " server threads could be started: " + error.what()};
  }
  return {};
}

void LoopThreads::run() noexcept {
  while (!contained([this] { loop_.run(); },
                    [this](const char* what) { report_(std::string("a task failed: ") + what); })) {
  }
}

void LoopThreads::stop() {
  loop_.stop();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

}  // namespace overfly::net
