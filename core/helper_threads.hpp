// Runs the same work on several threads.
#pragma once

#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace overfly {

/// Calls `work` on this thread and on up to `helpers` further threads, and returns when all have
/// finished. Rethrows the first exception.
/// @param helpers  number of further threads; `work` must be correct with fewer, as the system may
/// refuse to create them
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
    // No more threads are available: continue with those that started.
  }
  guarded();
  for (std::thread& thread : threads) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace overfly
