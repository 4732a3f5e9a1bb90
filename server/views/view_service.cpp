#include "server/views/view_service.hpp"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "core/barrier.hpp"
#include "core/cancel.hpp"
#include "server/timing/picture_rate.hpp"
#include "server/timing/thread_priority.hpp"
#include "server/views/view_painter.hpp"
#include "server/views/view_queue.hpp"

namespace overfly::server {
namespace {

/// Computes a value and hands it to whoever asked for it.
template <typename Value>
class AnsweredTask final : public ViewTask {
 public:
  /// Empty while a world is being opened.
  using Work = std::function<Result<std::optional<Value>>(ViewPainter&)>;
  using Done = std::function<void(Result<Value>)>;
  using Abandoned = std::shared_ptr<const std::atomic<bool>>;
  AnsweredTask(Work work, Done done, Abandoned abandoned)
      : work_(std::move(work)), done_(std::move(done)), abandoned_(std::move(abandoned)) {}

  bool run(ViewPainter& painter) override {
    if (is_cancelled(abandoned_.get())) {
      answer(Error{ErrorCode::kCancelled, "nobody waits for the answer"});
      return true;
    }
    Result<std::optional<Value>> value = guarded([&] { return work_(painter); });
    if (!value) {
      answer(value.error());
    } else if (*value) {
      answer(std::move(**value));
    } else {
      return false;
    }
    return true;
  }
  void refuse(const Error& reason) override { answer(reason); }

 private:
  /// If there is no memory for the answer, the client will ask again.
  void answer(Result<Value> value) {
    (void)contained([&] { done_(std::move(value)); }, [](const char*) {});
  }

  Work work_;
  Done done_;
  Abandoned abandoned_;  ///< may be null
};

/// The stream of the tasks below, which no picture has.
constexpr int kNoStream = -1;
/// Clients are counted from 1.
constexpr std::uint64_t kNoClient = 0;

/// Frees what the painter keeps for a client that has gone.
class FarewellTask final : public ViewTask {
 public:
  explicit FarewellTask(std::uint64_t client) : client_(client) {}
  bool run(ViewPainter& painter) override {
    painter.forget(client_);
    return true;
  }
  void refuse(const Error& /*reason*/) override {}

 private:
  std::uint64_t client_;
};

class DropDeletedTask final : public ViewTask {
 public:
  bool run(ViewPainter& painter) override {
    painter.drop_deleted();
    return true;
  }
  void refuse(const Error& /*reason*/) override {}
};

Error outdated() { return {ErrorCode::kCancelled, "a newer picture was requested"}; }

}  // namespace

struct ViewService::Impl {
  explicit Impl(RunManager& run_manager)
      : runs(run_manager), worlds(opening_functions()), thread([this] { work(); }) {}
  /// Cancels all runs and joins their threads.
  ~Impl();
  void work();
  void paint(bool beside_flight);
  /// Answers all waiting requests with an error.
  void refuse(const Error& reason);
  std::optional<ViewQueue::Entry> next(bool beside_flight);
  WorldOpener::Functions opening_functions();
  /// Runs one task, or puts it aside until its world is open.
  void serve(ViewQueue::Entry entry, ViewPainter& painter);
  void push(ViewQueue::Entry entry);

  RunManager& runs;
  std::mutex mutex;
  std::condition_variable wake;
  ViewQueue queue;
  std::vector<std::unique_ptr<ViewTask>> replaced;  ///< still to be answered, on the thread
  std::atomic<bool> stopping = false;               ///< written under the mutex
  std::uint64_t worlds_opened = 0;
  WorldOpener worlds;  ///< used by the drawing thread
  std::thread thread;  ///< last member, because it uses all of the above
};

ViewService::Impl::~Impl() {
  {
    const std::lock_guard lock(mutex);
    stopping = true;
  }
  wake.notify_one();
  thread.join();
}

/// Waits for the next picture to draw; meanwhile answers replaced requests. Empty at the end, and
/// when a real-time flight has begun or ended.
std::optional<ViewQueue::Entry> ViewService::Impl::next(bool beside_flight) {
  std::unique_lock lock(mutex);
  for (;;) {
    wake.wait(lock, [this] { return stopping || !queue.empty() || !replaced.empty(); });
    if (stopping || runs.picture_rate().flying() != beside_flight) return std::nullopt;
    if (replaced.empty()) return queue.pop();
    const std::vector<std::unique_ptr<ViewTask>> old = std::exchange(replaced, {});
    lock.unlock();
    for (const auto& task : old) task->refuse(outdated());
    lock.lock();
  }
}

void ViewService::Impl::work() {
  for (;;) {
    {
      std::unique_lock lock(mutex);
      wake.wait(lock, [this] { return stopping || !queue.empty() || !replaced.empty(); });
      if (stopping) break;
    }
    // A thread's priority can only be lowered: during a real-time flight another thread draws.
    const bool beside_flight = runs.picture_rate().flying();
    (void)contained(
        [&] { std::thread([this, beside_flight] { paint(beside_flight); }).join(); },
        [this](const char* what) {
          refuse({ErrorCode::kInternal, std::string("cannot start the drawing thread: ") + what});
        });
  }
  {
    const std::lock_guard lock(mutex);
    queue.release();
  }
  refuse({ErrorCode::kCancelled, "the server is shutting down"});
}

void ViewService::Impl::refuse(const Error& reason) {
  std::unique_lock lock(mutex);
  while (auto entry = queue.pop()) {
    lock.unlock();
    entry->task->refuse(reason);
    lock.lock();
  }
}

void ViewService::Impl::paint(bool beside_flight) {
  lower_thread(beside_flight ? ThreadPriority::kLeftOver : ThreadPriority::kBelowFlights);
  const auto paint_all = [&] {
    // The painter's renderers are created and destroyed on this thread.
    ViewPainter painter(runs, worlds, stopping);
    while (auto entry = next(beside_flight)) serve(std::move(*entry), painter);
  };
  (void)contained(paint_all, [this](const char* what) { refuse({ErrorCode::kInternal, what}); });
}

WorldOpener::Functions ViewService::Impl::opening_functions() {
  WorldOpener::Functions functions;
  functions.open = [this](const std::string& run_id, const std::function<bool()>& cancelled) {
    return runs.world_of(run_id, cancelled);
  };
  functions.opened = [this] {
    {
      const std::lock_guard lock(mutex);
      ++worlds_opened;
      queue.release();
    }
    wake.notify_one();
  };
  functions.priority = [this] {
    return runs.picture_rate().flying() ? ThreadPriority::kLeftOver : ThreadPriority::kBelowFlights;
  };
  return functions;
}

void ViewService::Impl::serve(ViewQueue::Entry entry, ViewPainter& painter) {
  std::uint64_t opened_before = 0;
  {
    const std::lock_guard lock(mutex);
    opened_before = worlds_opened;
  }
  if (entry.task->run(painter)) return;
  std::unique_ptr<ViewTask> old;
  {
    const std::lock_guard lock(mutex);
    old = queue.stand_aside(std::move(entry));
    if (worlds_opened != opened_before) queue.release();
  }
  if (old) old->refuse(outdated());
}

void ViewService::Impl::push(ViewQueue::Entry entry) {
  {
    const std::lock_guard lock(mutex);
    auto old = queue.push(std::move(entry));
    if (old) replaced.push_back(std::move(old));
  }
  wake.notify_one();
}

ViewService::ViewService(RunManager& runs) : impl_(std::make_unique<Impl>(runs)) {}
ViewService::~ViewService() = default;

void ViewService::request(std::uint64_t client,
                          int stream,
                          const PictureRequest& request,
                          PictureDone done,
                          std::shared_ptr<const std::atomic<bool>> abandoned) {
  const auto paint = [request](ViewPainter& painter) { return painter.paint(request); };
  impl_->push(
      {client,
       stream,
       std::make_unique<AnsweredTask<Picture>>(paint, std::move(done), std::move(abandoned))});
}

void ViewService::probe(std::uint64_t client,
                        int stream,
                        const PixelRequest& request,
                        PixelDone done,
                        std::shared_ptr<const std::atomic<bool>> abandoned) {
  const auto look = [request](ViewPainter& painter) { return painter.probe(request); };
  impl_->push(
      {client,
       stream,
       std::make_unique<AnsweredTask<PixelValue>>(look, std::move(done), std::move(abandoned))});
}

void ViewService::forget(std::uint64_t client) {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->queue.forget(client);
  }
  impl_->push({client, kNoStream, std::make_unique<FarewellTask>(client)});
}

void ViewService::drop_deleted() {
  impl_->push({kNoClient, kNoStream, std::make_unique<DropDeletedTask>()});
}

}  // namespace overfly::server
