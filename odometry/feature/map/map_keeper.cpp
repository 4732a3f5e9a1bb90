#include "odometry/feature/map/map_keeper.hpp"

#include <utility>

#include "core/measure/processor_time.hpp"
#include "odometry/shell/stage_stopwatch.hpp"

namespace overfly::odometry::feature {

MapKeeper::MapKeeper(const PinholeCamera& camera,
                     const MapperOptions& options,
                     const FeatureParameters& parameters)
    : mapper_(camera, options),
      images_kept_(options.images_kept),
      orb_(parameters),
      threaded_(parameters.threads > 1),
      focal_check_(camera) {
  orb_.look_only_at(options.seen);
  if (threaded_) thread_ = std::thread([this] { run(); });
}

MapKeeper::~MapKeeper() {
  if (!threaded_) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    work_.reset();
  }
  changed_.notify_all();
  thread_.join();
}

void MapKeeper::begin() {
  mapper_.add_candidates(orb_, map_);
  if (!threaded_) return;
  publish();
  refresh();
}

void MapKeeper::clear() { (void)release(); }

Map MapKeeper::release() {
  if (threaded_) {
    {
      const std::lock_guard lock(mutex_);
      work_.reset();
    }
    wait_until_idle();
    const std::lock_guard lock(mutex_);
    published_.reset();
    published_bytes_ = 0;
    failure_ = nullptr;
  }
  view_.reset();
  sights_.clear();
  focal_check_.new_map();
  return std::exchange(map_, {});
}

void MapKeeper::adopt(Map map) {
  clear();
  map_ = std::move(map);
  if (!threaded_) return;
  publish();
  refresh();
}

const Map& MapKeeper::refresh() {
  if (threaded_) {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    view_ = published_;
  }
  return view();
}

void MapKeeper::note_sights(const TrackResult& tracked) {
  for (const TrackedPoint& seen : tracked.points) {
    Sights& sights = sights_[seen.point];
    ++sights.expected;
    ++sights.found;
  }
  for (const TrackedPoint& seen : tracked.outliers) ++sights_[seen.point].expected;
  for (const int id : tracked.missed) ++sights_[id].expected;
}

bool MapKeeper::wants_keyframe(const FrameImage& frame, const TrackResult& tracked) const {
  if (threaded_) {
    const std::lock_guard lock(mutex_);
    if (busy_ || work_) return false;
  }
  return mapper_.wants_keyframe(frame, tracked, view());
}

Pose MapKeeper::insert_keyframe(const FrameImage& frame,
                                const TrackResult& tracked,
                                std::map<std::string, double>& timing_ms) {
  Work work{frame, tracked, std::exchange(sights_, {})};
  if (!threaded_) {
    map_keyframe(work, timing_ms);
    return map_.newest().T_camera_vo;
  }
  {
    const std::lock_guard lock(mutex_);
    work_ = std::move(work);
  }
  changed_.notify_all();
  return tracked.T_camera_vo;
}

void MapKeeper::take_timing(std::map<std::string, double>& timing_ms) {
  const std::lock_guard lock(mutex_);
  for (const auto& [stage, ms] : timing_ms_) timing_ms[stage] += ms;
  timing_ms_.clear();
}

double MapKeeper::take_cpu_s() {
  const std::lock_guard lock(mutex_);
  return std::exchange(cpu_s_, 0.0);
}

std::size_t MapKeeper::memory_bytes() const {
  if (!threaded_) return map_.memory_bytes();
  const std::lock_guard lock(mutex_);
  return published_bytes_;
}

std::vector<std::string> MapKeeper::take_warnings() {
  const std::lock_guard lock(mutex_);
  return std::exchange(warnings_, {});
}

void MapKeeper::wait_until_idle() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !busy_ && !work_; });
}

void MapKeeper::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || work_; });
    if (stop_) return;
    const Work work = *std::exchange(work_, std::nullopt);
    busy_ = true;
    lock.unlock();
    const double before_s = thread_cpu_s();
    std::map<std::string, double> timing_ms;
    std::exception_ptr failure;
    try {
      map_keyframe(work, timing_ms);
      publish();
    } catch (...) {
      failure = std::current_exception();
    }
    const double used_s = thread_cpu_s() - before_s;
    lock.lock();
    cpu_s_ += used_s;
    for (const auto& [stage, ms] : timing_ms) timing_ms_[stage] += ms;
    if (failure) failure_ = failure;
    busy_ = false;
    changed_.notify_all();
  }
}

void MapKeeper::map_keyframe(const Work& work, std::map<std::string, double>& timing_ms) {
  const StageStopwatch stopwatch(timing_ms, "mapping");
  count(work.sights);
  mapper_.extend(work.frame, work.tracked, map_, timing_ms);
  if (threaded_) publish();
  mapper_.refine(orb_, map_, timing_ms);
  const StageStopwatch check_watch(timing_ms, "focal_check");
  if (auto warning = focal_check_.after_keyframe(map_)) {
    const std::lock_guard lock(mutex_);
    warnings_.push_back(std::move(*warning));
  }
}

void MapKeeper::count(const std::unordered_map<int, Sights>& sights) {
  for (const auto& [id, seen] : sights) {
    MapPoint* point = map_.point(id);
    if (point == nullptr) continue;
    point->expected += seen.expected;
    point->found += seen.found;
  }
}

void MapKeeper::publish() {
  auto copy = std::make_shared<const Map>(map_.newest_part(images_kept_));
  const std::size_t bytes = map_.memory_bytes() + copy->memory_bytes() - copy->image_bytes();
  const std::lock_guard lock(mutex_);
  published_ = std::move(copy);
  published_bytes_ = bytes;
}

}  // namespace overfly::odometry::feature
