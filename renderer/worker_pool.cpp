#include "renderer/worker_pool.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace overfly::renderer {

namespace {

/// Number of polls before a thread sleeps, about 100 us. An image is cast in several rounds of a
/// few milliseconds, and waking a sleeping thread takes longer than the gap between rounds.
constexpr int kLooksBeforeSleep = 600;

template <typename Condition>
bool comes_soon(const Condition& condition) {
  for (int i = 0; i < kLooksBeforeSleep; ++i) {
    if (condition()) return true;
    std::this_thread::yield();
  }
  return false;
}

int chosen_threads(int wanted) {
  if (wanted > 0) return wanted;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 8);
}

}  // namespace

struct WorkerPool::State {
  /// An exception in a job (out of memory, for example) is kept for the caller of run().
  void work() {
    try {
      for (int i = next++; i < jobs; i = next++) (*job)(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!thrown) thrown = std::current_exception();
      next = jobs;
    }
  }

  [[nodiscard]] bool called(std::uint64_t seen) const { return stopping || round != seen; }

  void serve() {
    std::uint64_t seen = 0;
    while (true) {
      if (!comes_soon([&] { return called(seen); })) {
        std::unique_lock lock(mutex);
        begin.wait(lock, [&] { return called(seen); });
      }
      if (stopping) return;
      seen = round;
      work();
      if (--busy > 0) continue;
      const std::lock_guard lock(mutex);
      done.notify_one();
    }
  }

  std::mutex mutex;
  std::condition_variable begin, done;
  std::atomic<std::uint64_t> round{0};
  std::atomic<int> busy{0};  // threads that have not finished this round
  std::atomic<bool> stopping{false};
  const std::function<void(int)>* job = nullptr;
  int jobs = 0;
  std::atomic<int> next{0};
  std::exception_ptr thrown;  // by a job of this round
  std::vector<std::thread> threads;
};

WorkerPool::WorkerPool(int threads) : state_(std::make_unique<State>()) {
  try {
    for (int i = chosen_threads(threads); i > 1; --i)
      state_->threads.emplace_back([this] { state_->serve(); });
  } catch (const std::system_error&) {
    // The system cannot start more threads: the existing ones do all the work.
  }
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->stopping = true;
  }
  state_->begin.notify_all();
  for (std::thread& thread : state_->threads) thread.join();
}

int WorkerPool::threads() const { return static_cast<int>(state_->threads.size()) + 1; }

void WorkerPool::run(int jobs, const std::function<void(int)>& job) {
  if (state_->threads.empty() || jobs < 2) {
    for (int i = 0; i < jobs; ++i) job(i);
    return;
  }
  {
    const std::lock_guard lock(state_->mutex);
    state_->job = &job;
    state_->jobs = jobs;
    state_->next = 0;
    state_->busy = static_cast<int>(state_->threads.size());
    ++state_->round;
  }
  state_->begin.notify_all();
  state_->work();
  const auto all_done = [&] { return state_->busy == 0; };
  std::unique_lock lock(state_->mutex, std::defer_lock);
  if (!comes_soon(all_done)) {
    lock.lock();
    state_->done.wait(lock, all_done);
  }
  if (state_->thrown) std::rethrow_exception(std::exchange(state_->thrown, nullptr));
}

}  // namespace overfly::renderer
