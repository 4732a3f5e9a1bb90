#include "server/engine/view_service.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "server/engine/view_painter.hpp"
#include "server/engine/view_queue.hpp"

namespace overfly::engine {

struct ViewService::Impl {
  explicit Impl(RunManager& run_manager) : runs(run_manager), thread([this] { work(); }) {}
  ~Impl();
  void work();
  std::optional<ViewQueue::Entry> next();

  RunManager& runs;
  std::mutex mutex;
  std::condition_variable wake;
  ViewQueue queue;
  std::vector<Done> replaced;  ///< to be told so on the thread
  bool stopping = false;
  std::thread thread;  ///< last: it uses all of the above
};

ViewService::Impl::~Impl() {
  {
    const std::lock_guard lock(mutex);
    stopping = true;
  }
  wake.notify_one();
  thread.join();
}

/// The next picture to draw, once there is one; tells replaced ones meanwhile. Empty at the end.
std::optional<ViewQueue::Entry> ViewService::Impl::next() {
  std::unique_lock lock(mutex);
  for (;;) {
    wake.wait(lock, [this] { return stopping || !queue.empty() || !replaced.empty(); });
    if (stopping) return std::nullopt;
    if (replaced.empty()) return queue.pop();
    const std::vector<Done> told = std::exchange(replaced, {});
    lock.unlock();
    for (const Done& done : told) {
      done(Error{ErrorCode::kCancelled, "a newer picture was asked for"});
    }
    lock.lock();
  }
}

void ViewService::Impl::work() {
  // The painter's renderers live and die on this thread.
  ViewPainter painter(runs);
  while (auto entry = next()) entry->done(painter.paint(entry->request));
}

ViewService::ViewService(RunManager& runs) : impl_(std::make_unique<Impl>(runs)) {}
ViewService::~ViewService() = default;

void ViewService::request(std::uint64_t client,
                          int stream,
                          const PictureRequest& request,
                          Done done) {
  {
    const std::lock_guard lock(impl_->mutex);
    Done replaced = impl_->queue.push({client, stream, request, std::move(done)});
    if (replaced) impl_->replaced.push_back(std::move(replaced));
  }
  impl_->wake.notify_one();
}

void ViewService::forget(std::uint64_t client) {
  const std::lock_guard lock(impl_->mutex);
  impl_->queue.forget(client);
}

}  // namespace overfly::engine
