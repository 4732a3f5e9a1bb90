// The same work on several threads at once.
#pragma once

#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace overfly {

/// Calls `work` here and on as many further threads as the system gives, and returns when all are
/// done. Whatever one of them throws is thrown here.
/// @param helpers  threads besides this one; work must be right with fewer
template <typename Work>
void work_with_helpers(unsigned helpers, const Work& work) {
  std::mutex mutex;
  std::exception_ptr thrown;
  const auto guarded = [&] {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!thrown) thrown = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  threads.reserve(helpers);
  try {
    for (unsigned i = 0; i < helpers; ++i) threads.emplace_back(guarded);
  } catch (const std::system_error&) {
    // The system has no more threads: those that are there do the same work.
  }
  guarded();
  for (std::thread& thread : threads) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace overfly
