#include "renderer/tiles/tile_store.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <ctime>
#include <deque>
#include <exception>
#include <list>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "core/barrier.hpp"
#include "core/measure/processor_time.hpp"
#include "renderer/tiles/tile_pixels.hpp"

namespace overfly::renderer {

using terrain::TileId;

namespace {

/// Maximum number of waiting requests of `find`; older ones are dropped and requested again if
/// needed.
constexpr std::size_t kMaxAsked = 256;
/// Maximum number of waiting requests of `read_when_idle`; further ones are dropped.
constexpr std::size_t kMaxSomeTime = 20'000;
/// A thread's pause between two tiles read ahead, relative to the time spent on the last one.
constexpr double kRestPerWork = 6.0;

/// Reads the elevation under a tile, at about the resolution needed to draw the tile.
void touch_heights(const terrain::TileSource& tiles, const TileId& id) {
  constexpr int kSteps = 4;
  constexpr double kSpacingTexels = 8.0;
  const terrain::TileGrid& grid = tiles.grid();
  const double texel_m = std::ldexp(grid.texel_m, id.level);
  const double side_m = terrain::kTileTexels * texel_m;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const double x_m = grid.left_x_m + (id.col + static_cast<double>(i) / kSteps) * side_m;
      const double y_m = grid.top_y_m - (id.row + static_cast<double>(j) / kSteps) * side_m;
      (void)tiles.coarse_world_from_map(x_m, y_m, kSpacingTexels * texel_m);
    }
  }
}

}  // namespace

/// The data protected by the lock, and the threads.
struct TileStore::State {
  using Key = std::pair<TileId, PixelFormat>;
  /// kNow: a frame is drawn without it; kSoon: by prefetch; kSomeTime: by read_when_idle.
  enum class Need { kNow, kSoon, kSomeTime };
  using Pixels = std::shared_ptr<const TilePixels>;
  using Order = std::list<Key>;  // last used first
  struct Entry {
    Pixels pixels;
    std::size_t bytes = 0;
    std::uint64_t round = 0;  // of prefetch calls, when it was last needed
    Order::iterator place;
  };

  State(std::shared_ptr<const terrain::TileSource> source, const TileStoreOptions& wanted)
      : tiles(std::move(source)), options(wanted) {
    try {
      for (int i = 0; i < options.threads; ++i) threads.emplace_back([this] { fetch_ahead(); });
    } catch (const std::system_error&) {
      // The system cannot start more threads: without any, tiles are read on demand.
    }
  }

  ~State() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
    }
    work.notify_all();
    for (std::thread& thread : threads) thread.join();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// The entry, marked as used. @pre the lock is held
  Pixels use(const Key& key) {
    const auto found = entries.find(key);
    if (found == entries.end()) return nullptr;
    found->second.round = round;
    order.splice(order.begin(), order, found->second.place);
    return found->second.pixels;
  }

  /// Stores a tile and evicts the least recently used ones. @pre the lock is held
  void keep(const Key& key, const Pixels& pixels) {
    const std::size_t bytes = pixels->bytes();
    Order place(1, key);
    entries.emplace(key, Entry{pixels, bytes, round, place.begin()});
    order.splice(order.begin(), place);
    held_bytes += bytes;
    largest_bytes = std::max(largest_bytes, bytes);
    while (held_bytes > options.budget_bytes && !order.empty()) {
      const auto oldest = entries.find(order.back());
      held_bytes -= oldest->second.bytes;
      entries.erase(oldest);
      order.pop_back();
      ++counts.let_go;
    }
  }

  /// Leaves the processor to the frames in between, unless a frame is being drawn without a tile.
  void rest(double spent_s, std::unique_lock<std::mutex>& lock) {
    work.wait_for(lock, std::chrono::duration<double>(kRestPerWork * spent_s), [this] {
      return stopping || waiting > 0 || !asked.empty();
    });
  }

  /// A tile's pixels, read without the lock; out of memory is an ordinary error.
  Result<Pixels> read(const Key& key, Need need, std::unique_lock<std::mutex>& lock) {
    try {
      const double before_s = thread_cpu_s();
      const Result<terrain::Tile> tile = tiles->tile(key.first);
      if (need != Need::kNow) {
        // Where elevation cannot be read, only views of that place must fail.
        if (need == Need::kSoon) touch_heights(*tiles, key.first);
        lock.lock();
        rest(thread_cpu_s() - before_s, lock);
        lock.unlock();
      }
      if (!tile) return tile.error();
      return Pixels(std::make_shared<const TilePixels>(tile_pixels_from(*tile, key.second)));
    } catch (const std::exception& error) {
      return Error{ErrorCode::kInternal, error.what()};
    }
  }

  /// Reads a tile that this thread has put into `loading`; releases the lock meanwhile.
  Result<Pixels> load(const Key& key, Need need, std::unique_lock<std::mutex>& lock) {
    lock.unlock();
    const Result<Pixels> pixels = read(key, need, lock);
    lock.lock();
    loading.erase(key);
    // If there is no memory to store it, it is read again when needed.
    if (pixels) (void)contained([&] { keep(key, *pixels); }, [](const char*) {});
    loaded.notify_all();
    if (pixels) return pixels;
    const TileId& id = key.first;
    return pixels.error().in("tile " + std::to_string(id.level) + "/" + std::to_string(id.col) +
                             "/" + std::to_string(id.row));
  }

  Result<Pixels> get(const Key& key) {
    std::unique_lock lock(mutex);
    while (true) {
      if (Pixels pixels = use(key); pixels != nullptr) return pixels;
      if (loading.insert(key).second) break;
      ++waiting;
      work.notify_all();
      loaded.wait(lock);
      --waiting;
    }
    ++counts.read_on_demand;
    return load(key, Need::kNow, lock);
  }

  void load_all(std::span<const TileId> ids, PixelFormat format, std::int64_t limit_ns) {
    using Clock = std::chrono::steady_clock;
    const bool limited = limit_ns != kForAllTiles;
    // Without threads `get` and `find` read; a single tile is read by `get` as fast.
    if (threads.empty() || (!limited && ids.size() < 2)) return;
    const auto end = Clock::now() + std::chrono::nanoseconds(limited ? limit_ns : 0);
    std::unique_lock lock(mutex);
    for (const TileId& id : ids) ask({id, format});
    work.notify_all();
    // The threads begin with the first one, this thread with the last one.
    for (std::size_t i = ids.size(); i-- > 0;) {
      if (limited && Clock::now() >= end) return;
      const Key key{ids[i], format};
      if (entries.count(key) != 0 || !loading.insert(key).second) continue;
      ++counts.read_on_demand;
      (void)load(key, Need::kNow, lock);
    }
    // `get` waits for a tile that another thread is still reading, `find` does not.
    if (!limited) return;
    // So that a thread that rests with a tile does not.
    ++waiting;
    work.notify_all();
    loaded.wait_until(lock, end, [&] {
      return std::none_of(ids.begin(), ids.end(), [&](const TileId& id) {
        return loading.contains({id, format});
      });
    });
    --waiting;
  }

  /// Requests a tile from the threads, unless it is here or on its way. @pre the lock is held
  void ask(const Key& key) {
    if (entries.count(key) != 0 || loading.count(key) != 0) return;
    if (std::find(asked.begin(), asked.end(), key) != asked.end()) return;
    asked.push_back(key);
    if (asked.size() > kMaxAsked) asked.pop_front();
  }

  Pixels find(const Key& key) {
    if (threads.empty()) {
      Result<Pixels> read = get(key);
      return read.ok() ? *read : nullptr;
    }
    const std::lock_guard lock(mutex);
    if (Pixels pixels = use(key); pixels != nullptr) return pixels;
    ask(key);
    work.notify_one();
    return nullptr;
  }

  void prefetch(std::span<const TileId> ids, PixelFormat format) {
    const std::lock_guard lock(mutex);
    ++round;
    ahead.clear();
    // Starts with the least urgent one, so that the most urgent one is evicted last.
    for (std::size_t i = ids.size(); i-- > 0;) (void)use({ids[i], format});
    for (const TileId& id : ids) {
      if (const Key key{id, format}; entries.count(key) == 0) ahead.push_back(key);
    }
    if (!ahead.empty()) work.notify_all();
  }

  void read_when_idle(std::span<const TileId> ids, PixelFormat format) {
    const std::lock_guard lock(mutex);
    for (const TileId& id : ids) {
      if (some_time.size() >= kMaxSomeTime) break;
      some_time.push_back({id, format});
    }
    work.notify_all();
  }

  /// True if a tile as large as the largest so far would evict another. @pre the lock is held
  [[nodiscard]] bool no_room() const { return held_bytes + largest_bytes > options.budget_bytes; }

  /// True if the tile to be evicted next is still needed. @pre the lock is held
  [[nodiscard]] bool full() const {
    if (order.empty() || held_bytes + entries.at(order.back()).bytes <= options.budget_bytes) {
      return false;
    }
    return entries.at(order.back()).round + 1 >= round;
  }

  /// The next tile to read, put into `loading`; with who needs it. @pre the
  /// lock is held
  bool take_next(Key& key, Need& need) {
    const auto take_from = [&](std::deque<Key>& queue) {
      while (!queue.empty()) {
        key = queue.front();
        queue.pop_front();
        if (entries.count(key) == 0 && loading.insert(key).second) return true;
      }
      return false;
    };
    need = Need::kNow;
    if (take_from(asked)) return true;
    if (!ahead.empty() && full()) ahead.clear();
    need = Need::kSoon;
    if (take_from(ahead)) return true;
    need = Need::kSomeTime;
    if (no_room()) some_time.clear();
    return take_from(some_time);
  }

  void fetch_ahead() {
    std::unique_lock lock(mutex);
    // A tile that cannot be read ahead for lack of memory is read when it is drawn.
    while (!stopping) (void)contained([&] { fetch_next(lock); }, [](const char*) {});
  }

  void fetch_next(std::unique_lock<std::mutex>& lock) {
    Key key;
    Need need = Need::kNow;
    if (!take_next(key, need)) {
      loaded.notify_all();
      work.wait(lock);
      return;
    }
    ++counts.read_ahead;
    const double before_s = thread_cpu_s();
    // An error is reported to the caller that gets the tile.
    (void)load(key, need, lock);
    const double spent_s = thread_cpu_s() - before_s;
    counts.ahead_cpu_s += spent_s;
    // Tiles read ahead are not needed for seconds.
    if (need != Need::kNow) rest(spent_s, lock);
  }

  std::shared_ptr<const terrain::TileSource> tiles;
  TileStoreOptions options;
  mutable std::mutex mutex;
  std::condition_variable loaded;  // a tile was read, or a thread ran out of work
  std::condition_variable work;    // a request was added, or the end
  std::map<Key, Entry> entries;
  Order order;
  std::size_t held_bytes = 0;
  std::size_t largest_bytes = 0;  // of a tile so far
  std::set<Key> loading;
  std::deque<Key> asked;      // requested by find
  std::deque<Key> ahead;      // requested by prefetch
  std::deque<Key> some_time;  // requested by read_when_idle
  std::uint64_t round = 0;
  bool stopping = false;
  int waiting = 0;  // threads that need a tile that is being read
  TileStoreCounts counts;
  std::vector<std::thread> threads;
};

TileStore::TileStore(std::shared_ptr<const terrain::TileSource> tiles,
                     const TileStoreOptions& options)
    : state_(std::make_unique<State>(std::move(tiles), options)) {}

TileStore::~TileStore() = default;

Result<std::shared_ptr<const TilePixels>> TileStore::get(const TileId& id, PixelFormat format) {
  return state_->get({id, format});
}

void TileStore::load(std::span<const TileId> ids, PixelFormat format, std::int64_t limit_ns) {
  state_->load_all(ids, format, limit_ns);
}

std::shared_ptr<const TilePixels> TileStore::find(const TileId& id, PixelFormat format) {
  return state_->find({id, format});
}

std::shared_ptr<const TilePixels> TileStore::peek(const TileId& id, PixelFormat format) {
  const std::lock_guard lock(state_->mutex);
  return state_->use({id, format});
}

void TileStore::prefetch(std::span<const TileId> ids, PixelFormat format) {
  if (!state_->threads.empty()) state_->prefetch(ids, format);
}

void TileStore::read_when_idle(std::span<const TileId> ids, PixelFormat format) {
  if (!state_->threads.empty()) state_->read_when_idle(ids, format);
}

void TileStore::wait_until_idle() {
  std::unique_lock lock(state_->mutex);
  state_->loaded.wait(lock, [this] {
    return state_->loading.empty() && state_->asked.empty() && state_->ahead.empty() &&
           state_->some_time.empty();
  });
}

std::size_t TileStore::held_bytes() const {
  const std::lock_guard lock(state_->mutex);
  return state_->held_bytes;
}

TileStoreCounts TileStore::counts() const {
  const std::lock_guard lock(state_->mutex);
  return state_->counts;
}

const terrain::TileSource& TileStore::tiles() const { return *state_->tiles; }

}  // namespace overfly::renderer
