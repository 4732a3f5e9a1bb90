#include "server/views/world_opener.hpp"

#include <algorithm>
#include <atomic>
#include <list>
#include <mutex>
#include <thread>
#include <utility>

#include "core/barrier.hpp"

namespace overfly::server {
namespace {

/// Results that nobody took; the oldest is dropped.
constexpr std::size_t kMaxResults = 8;

}  // namespace

struct WorldOpener::Impl {
  explicit Impl(Functions given) : functions(std::move(given)) {}
  void open(const std::string& run_id);

  struct Opening {
    std::string run_id;
    bool done = false;
    std::thread thread;
  };
  const Functions functions;
  std::mutex mutex;
  std::atomic<bool> stopping = false;
  std::list<Opening> openings;  ///< each with its thread; those done are joined by the next take()
  std::list<std::pair<std::string, Result<World>>> results;
};

void WorldOpener::Impl::open(const std::string& run_id) {
  lower_thread(functions.priority());
  Result<World> world =
      guarded([&] { return functions.open(run_id, [this] { return stopping.load(); }); });
  const auto keep = [&] {
    const std::lock_guard lock(mutex);
    results.emplace_back(run_id, std::move(world));
    if (results.size() > kMaxResults) results.pop_front();
  };
  (void)contained(keep, [](const char*) {});
  {
    const std::lock_guard lock(mutex);
    for (Opening& opening : openings) {
      if (opening.run_id == run_id) opening.done = true;
    }
  }
  (void)contained([&] { functions.opened(); }, [](const char*) {});
}

WorldOpener::WorldOpener(Functions functions)
    : impl_(std::make_unique<Impl>(std::move(functions))) {}

WorldOpener::~WorldOpener() {
  impl_->stopping = true;
  for (Impl::Opening& opening : impl_->openings) opening.thread.join();
}

std::optional<Result<WorldOpener::World>> WorldOpener::take(const std::string& run_id) {
  Impl& impl = *impl_;
  std::list<Impl::Opening> done;
  std::unique_lock lock(impl.mutex);
  for (auto opening = impl.openings.begin(); opening != impl.openings.end();) {
    const auto next = std::next(opening);
    if (opening->done) done.splice(done.end(), impl.openings, opening);
    opening = next;
  }
  std::optional<Result<World>> world;
  const auto result = std::find_if(impl.results.begin(), impl.results.end(), [&](const auto& kept) {
    return kept.first == run_id;
  });
  const auto is_run = [&](const Impl::Opening& opening) { return opening.run_id == run_id; };
  if (result != impl.results.end()) {
    world = std::move(result->second);
    impl.results.erase(result);
  } else if (impl.openings.size() < kMaxThreads &&
             std::none_of(impl.openings.begin(), impl.openings.end(), is_run)) {
    impl.openings.push_back({run_id, false, {}});
    try {
      impl.openings.back().thread = std::thread([&impl, run_id] { impl.open(run_id); });
    } catch (...) {
      impl.openings.pop_back();
      throw;
    }
  }
  lock.unlock();
  for (Impl::Opening& opening : done) opening.thread.join();
  return world;
}

}  // namespace overfly::server
