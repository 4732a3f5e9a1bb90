#include "renderer/raycast/worker_pool.hpp"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

namespace overfly::renderer::raycast {

struct WorkerPool::State {
  void work() {
    for (int i = next++; i < jobs; i = next++) (*job)(i);
  }

  void serve() {
    std::uint64_t seen = 0;
    std::unique_lock lock(mutex);
    while (true) {
      begin.wait(lock, [&] { return stopping || round != seen; });
      if (stopping) return;
      seen = round;
      lock.unlock();
      work();
      lock.lock();
      if (--busy == 0) done.notify_one();
    }
  }

  std::mutex mutex;
  std::condition_variable begin, done;
  std::uint64_t round = 0;
  int busy = 0;  // threads that have not finished this round
  bool stopping = false;
  const std::function<void(int)>* job = nullptr;
  int jobs = 0;
  std::atomic<int> next{0};
  std::vector<std::thread> threads;
};

WorkerPool::WorkerPool(int threads) : state_(std::make_unique<State>()) {
  for (int i = 1; i < threads; ++i) state_->threads.emplace_back([this] { state_->serve(); });
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
  std::unique_lock lock(state_->mutex);
  state_->done.wait(lock, [&] { return state_->busy == 0; });
}

}  // namespace overfly::renderer::raycast
