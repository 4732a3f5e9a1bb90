#include "renderer/camera/view_ahead.hpp"

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <ctime>
#include <deque>
#include <exception>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "core/measure/processor_time.hpp"
#include "renderer/camera/image_parts.hpp"
#include "renderer/ground/ground_selection.hpp"

namespace overfly::renderer {

using terrain::TileId;

namespace {

constexpr int kViews = 3;
/// Wider than the camera's image, so that a turn within kAheadS finds its ground as well.
constexpr double kWidening = 4.0 / 3.0;
constexpr std::int64_t kEveryNs = static_cast<std::int64_t>(kAheadEveryS * 1e9);

PinholeCamera widened(const PinholeCamera& camera) {
  PinholeCamera wide = camera;
  wide.width_px = static_cast<int>(std::lround(kWidening * camera.width_px));
  wide.height_px = static_cast<int>(std::lround(kWidening * camera.height_px));
  wide.cx_px += 0.5 * (wide.width_px - camera.width_px);
  wide.cy_px += 0.5 * (wide.height_px - camera.height_px);
  return wide;
}

}  // namespace

struct ViewAhead::State {
  State(std::shared_ptr<TileStore> tile_store, std::shared_ptr<GroundPatchStore> patch_store)
      : tiles(std::move(tile_store)),
        store(std::move(patch_store)),
        patches(store),
        thread([this] { run(); }) {}

  ~State() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
    }
    changed.notify_all();
    thread.join();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void run() {
    std::unique_lock lock(mutex);
    while (!stopping) {
      if (waiting.empty() && !later.empty()) {
        look_later(lock);
        continue;
      }
      if (waiting.empty()) {
        busy = false;
        changed.notify_all();
        changed.wait(lock);
        continue;
      }
      busy = true;
      const std::vector<CameraRequest> requests = std::exchange(waiting, {});
      const bool other_time = std::exchange(is_other_time, false);
      lock.unlock();
      if (other_time) wanted = {};
      const double before_s = thread_cpu_s();
      try {
        look_ahead(requests);
      } catch (const std::exception&) {
        // Out of memory for reading ahead: the views read what they need when they are drawn.
      }
      const double spent_s = thread_cpu_s() - before_s;
      lock.lock();
      cpu_s += spent_s;
    }
  }

  /// Samples the next view of `later`, then rests, unless something else is to be done.
  void look_later(std::unique_lock<std::mutex>& lock) {
    busy = true;
    const View view = later.front();
    later.pop_front();
    lock.unlock();
    const double before_s = thread_cpu_s();
    bool has_room = store->has_room();
    try {
      if (has_room) (void)select_ground(patches, view, {}, [](const GroundPatch&) {});
    } catch (const std::exception&) {
      has_room = false;
    }
    patches.end_view();
    const double spent_s = thread_cpu_s() - before_s;
    lock.lock();
    cpu_s += spent_s;
    if (!has_room) later.clear();
    changed.wait_for(lock, std::chrono::duration<double>(spent_s), [this] {
      return stopping || !waiting.empty();
    });
  }

  void look_ahead(const std::vector<CameraRequest>& requests) {
    std::vector<TileId> ids;
    const auto add = [&](const TileId& id) {
      if (wanted.known.insert(id).second) ids.push_back(id);
    };
    for (int i = 1; i <= kViews; ++i) {
      for (const CameraRequest& request : requests) {
        const double before_s = thread_cpu_s();
        Pose pose = request.T_world_camera.at(request.t_ns);
        pose.translation += request.velocity_world_m_s * (kAheadS * i / kViews);
        // The checks of a request and its depth read the elevation below the camera.
        (void)patches.tiles().ground_up_m(pose.translation.x(), pose.translation.y());
        const View view = View::from(widened(covering_pinhole(request.camera)), pose);
        for (const GroundLeaf& leaf : select_ground(patches, view, {}, [](const GroundPatch&) {})) {
          if (leaf.textured) add(leaf.texture);
        }
        patches.end_view();
        // Not urgent: leaves the processor to the frames in between.
        std::this_thread::sleep_for(std::chrono::duration<double>(thread_cpu_s() - before_s));
      }
    }
    const int levels = tiles->tiles().grid().levels;
    for (std::size_t i = 0, count = ids.size(); i < count; ++i) {
      const TileId& id = ids[i];
      if (id.level + 1 < levels) add({id.level + 1, id.col >> 1, id.row >> 1});
    }
    // The cameras of an aircraft normally share a format; otherwise the others' tiles are read on
    // demand.
    wanted.ids.insert(wanted.ids.end(), ids.begin(), ids.end());
    tiles->prefetch(wanted.ids, requests.front().format);
  }

  std::shared_ptr<TileStore> tiles;
  std::shared_ptr<GroundPatchStore> store;
  GroundPatches patches;
  /// Tiles for all cameras of the latest time, those of the first camera first: a request for tiles
  /// replaces the previous one. Used by the thread only.
  struct Wanted {
    std::vector<TileId> ids;
    std::set<TileId> known;
  };
  Wanted wanted;
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<CameraRequest> waiting;  // of the same time
  std::deque<View> later;              // of expect_later
  bool is_other_time = false;          // than that of the requests before
  std::int64_t looked_at_ns = -kEveryNs;
  bool busy = true;
  bool stopping = false;
  double cpu_s = 0.0;
  std::thread thread;  // last member: starts after all others are initialised
};

ViewAhead::ViewAhead(std::shared_ptr<TileStore> tiles, std::shared_ptr<GroundPatchStore> patches)
    : state_(std::make_unique<State>(std::move(tiles), std::move(patches))) {}

ViewAhead::~ViewAhead() = default;

void ViewAhead::expect(const CameraRequest& request) {
  if (request.velocity_world_m_s.isZero(0.0)) return;
  const std::lock_guard lock(state_->mutex);
  const bool same_time = request.t_ns == state_->looked_at_ns;
  if (!same_time) {
    if (std::llabs(request.t_ns - state_->looked_at_ns) < kEveryNs) return;
    state_->waiting.clear();
    state_->is_other_time = true;
    state_->looked_at_ns = request.t_ns;
  }
  state_->waiting.push_back(request);
  state_->changed.notify_all();
}

void ViewAhead::expect_later(std::vector<View> views) {
  const std::lock_guard lock(state_->mutex);
  state_->later.assign(views.begin(), views.end());
  state_->changed.notify_all();
}

void ViewAhead::wait_until_idle() {
  std::unique_lock lock(state_->mutex);
  state_->changed.wait(
      lock, [this] { return !state_->busy && state_->waiting.empty() && state_->later.empty(); });
}

double ViewAhead::cpu_s() const {
  const std::lock_guard lock(state_->mutex);
  return state_->cpu_s;
}

}  // namespace overfly::renderer
