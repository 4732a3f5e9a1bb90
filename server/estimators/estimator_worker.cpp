#include "server/estimators/estimator_worker.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/cancel.hpp"
#include "core/measure/crc32.hpp"
#include "core/measure/processor_time.hpp"
#include "core/time.hpp"
#include "server/timing/cpu_affinity.hpp"

namespace overfly::server {
namespace {

EstimatorEvent drop_of(const VoFrame& frame) {
  EstimatorEvent event;
  event.record.sample.frame = frame.index;
  event.record.sample.t_ns = frame.t_ns;
  event.record.dropped = true;
  return event;
}

/// Returns 0 for a rate of 0.
std::int64_t period_ns(double rate_hz) {
  return rate_hz > 0.0 ? std::llround(static_cast<double>(kNsPerS) / rate_hz) : 0;
}

}  // namespace

EstimatorWorker::EstimatorWorker(std::unique_ptr<VoPort> port,
                                 EstimatorWorkerOptions options,
                                 RunClock& clock)
    : port_(std::move(port)),
      driver_(*port_),
      options_(std::move(options)),
      clock_(clock),
      ready_ns_(clock.now_ns()),
      debug_period_ns_(period_ns(options_.debug_hz)) {
  thread_ = std::thread([this] { work(); });
}

EstimatorWorker::~EstimatorWorker() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    if ((!waiting_.empty() || to_prepare_) && !busy_) clock_.leave();
    waiting_.clear();
    to_prepare_.reset();
  }
  changed_.notify_all();
  thread_.join();
}

void EstimatorWorker::prepare(VoFrame first) {
  {
    const std::lock_guard lock(mutex_);
    clock_.enter();
    to_prepare_ = std::move(first);
  }
  changed_.notify_all();
}

void EstimatorWorker::submit(VoFrame frame) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() > options_.frames_ahead) {
      drops_.push_back(drop_of(waiting_.back().frame));
      SensorSamples samples = std::move(waiting_.back().frame.sensors);
      append(samples, std::move(frame.sensors));
      drop_older_than(samples, kOldestSampleNs);
      frame.sensors = std::move(samples);
      waiting_.pop_back();
    } else if (!busy_ && waiting_.empty()) {
      clock_.enter();
    }
    waiting_.push_back({std::move(frame), clock_.now_ns()});
  }
  changed_.notify_all();
}

void EstimatorWorker::wait_until_idle() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty() && !to_prepare_ && !busy_; });
  rethrow_failure();
}

bool EstimatorWorker::has_answered(std::int64_t frame) const {
  return !(busy_ && frame_in_progress_ <= frame) &&
         (waiting_.empty() || waiting_.front().frame.index > frame);
}

void EstimatorWorker::wait_until_answered(std::int64_t frame) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return has_answered(frame); });
  rethrow_failure();
}

bool EstimatorWorker::answered(std::int64_t frame) const {
  const std::lock_guard lock(mutex_);
  return has_answered(frame);
}

void EstimatorWorker::forget_after(std::int64_t frame) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.empty()) return;
    while (!waiting_.empty() && waiting_.back().frame.index > frame) waiting_.pop_back();
    if (waiting_.empty() && !busy_) clock_.leave();
  }
  changed_.notify_all();
}

std::vector<EstimatorEvent> EstimatorWorker::take_events(std::int64_t frame) {
  const std::lock_guard lock(mutex_);
  rethrow_failure();
  const auto first_later =
      std::find_if(events_.begin(), events_.end(), [&](const EstimatorEvent& event) {
        return event.record.sample.frame > frame;
      });
  std::vector<EstimatorEvent> taken(std::make_move_iterator(events_.begin()),
                                    std::make_move_iterator(first_later));
  events_.erase(events_.begin(), first_later);
  return taken;
}

void EstimatorWorker::rethrow_failure() {
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

EstimatorUse EstimatorWorker::use() {
  EstimatorUse use;
  use.cpu_s = cpu_s_;
  if (const std::optional<ResourceUse> own = driver_.use()) {
    use.cpu_s = own->cpu_s;
    use.peak_memory_mb = own->peak_memory_mb;
    use.measured =
        own->own_process ? EstimatorUse::Measured::kProcess : EstimatorUse::Measured::kOwnAccount;
  }
  const double elapsed_s = s_from_ns(clock_.now_ns() - ready_ns_);
  if (elapsed_s > 0.0) use.cpu_percent = 100.0 * use.cpu_s / elapsed_s;
  return use;
}

void EstimatorWorker::work() {
  // The processors were checked when the estimator was created. If one was removed since then, the
  // worker continues without it.
  (void)bind_thread(options_.cpus);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || to_prepare_ || !waiting_.empty(); });
    if (stopping_) return;
    busy_ = true;
    try {
      if (to_prepare_) {
        make_ready(lock);
      } else {
        answer_waiting(lock);
      }
    } catch (...) {
      // Out of memory even for the answer: the failure is reported at the run's next call.
      if (!lock.owns_lock()) lock.lock();
      thrown_ = std::current_exception();
    }
    busy_ = false;
    if (waiting_.empty()) clock_.leave();
    changed_.notify_all();
  }
}

void EstimatorWorker::make_ready(std::unique_lock<std::mutex>& lock) {
  const VoFrame first = *std::exchange(to_prepare_, std::nullopt);
  frame_in_progress_ = first.index;
  lock.unlock();
  driver_.prepare(first);
  ready_ns_ = clock_.now_ns();
  lock.lock();
}

void EstimatorWorker::answer_waiting(std::unique_lock<std::mutex>& lock) {
  Waiting taken = std::move(waiting_.front());
  waiting_.pop_front();
  frame_in_progress_ = taken.frame.index;
  if (options_.frames_ahead > 0) {
    taken.handed_over_ns = std::max(taken.handed_over_ns, idle_from_ns_);
  }
  // Frames dropped before this one was taken are reported before its answer.
  std::move(drops_.begin(), drops_.end(), std::back_inserter(events_));
  drops_.clear();
  lock.unlock();
  EstimatorEvent event = answer(taken);
  if (options_.answered && !event.record.dropped) options_.answered(event.record);
  lock.lock();
  if (options_.frames_ahead > 0) event.log = take_lines();
  idle_from_ns_ = clock_.now_ns();
  events_.push_back(std::move(event));
}

EstimatorEvent EstimatorWorker::answer(const Waiting& waiting) {
  EstimatorEvent event;
  event.record = lost_record(waiting.frame);
  if (crashed_) return event;
  Result<VoEstimate> estimate = track(waiting.frame);
  // The run was stopped before the estimator had taken its time for this frame.
  if (estimate && !hold_back(waiting)) return drop_of(waiting.frame);
  event.latency_ms = static_cast<double>(clock_.now_ns() - waiting.handed_over_ns) * 1e-6;
  constexpr std::int64_t kAnswersPerUse = 16;
  if (!estimate || answers_++ % kAnswersPerUse == 0) event.use = use();
  if (!estimate) {
    // The run was stopped, and the estimator with it during a frame; this is not an error of the
    // estimator.
    if (estimate.error().code == ErrorCode::kCancelled) return drop_of(waiting.frame);
    crashed_ = true;
    event.record.crash = estimate.error().message;
    event.record.hung = estimate.error().code == ErrorCode::kTimeout;
    return event;
  }
  event.record = record_of(*estimate);
  event.record.image_crc32 = estimate->image_crc32;
  if (options_.in_process && !event.record.image_crc32) {
    event.record.image_crc32 = crc32_of(*waiting.frame.image);
  }
  event.debug_image = std::move(estimate->debug_image);
  event.map_points_vo = std::move(estimate->map_points_vo);
  event.timing_ms = std::move(estimate->timing_ms);
  return event;
}

Result<VoEstimate> EstimatorWorker::track(const VoFrame& frame) {
  const double before_s = thread_cpu_s();
  Result<VoEstimate> estimate = driver_.track(frame, takes_debug(frame.t_ns));
  cpu_s_ += thread_cpu_s() - before_s;
  std::vector<std::string> notes = driver_.take_notes();
  const std::lock_guard lock(mutex_);
  std::move(notes.begin(), notes.end(), std::back_inserter(notes_));
  return estimate;
}

std::vector<std::string> EstimatorWorker::take_lines() {
  std::vector<std::string> lines = port_->take_log();
  std::move(notes_.begin(), notes_.end(), std::back_inserter(lines));
  notes_.clear();
  return lines;
}

std::vector<std::string> EstimatorWorker::take_log() {
  const std::lock_guard lock(mutex_);
  // Lines of a frame in progress, or taken before its event, would come in an earlier one's place.
  const bool belong_to_events = options_.frames_ahead > 0 && (busy_ || !waiting_.empty());
  return belong_to_events ? std::vector<std::string>() : take_lines();
}

bool EstimatorWorker::hold_back(const Waiting& waiting) {
  if (options_.throttle_hz <= 0.0) return true;
  // Counts from when it could take the frame, not from when this thread woke up, to avoid drift.
  const std::int64_t taken_ns = std::max(waiting.handed_over_ns, free_at_ns_);
  free_at_ns_ = std::max(taken_ns + period_ns(options_.throttle_hz), clock_.now_ns());
  return clock_.wait_until_ns(free_at_ns_, [this] {
    const std::lock_guard lock(mutex_);
    return stopping_ || is_cancelled(options_.cancel);
  });
}

bool EstimatorWorker::takes_debug(std::int64_t t_ns) {
  const bool wanted = debug_period_ns_ > 0 && t_ns >= next_debug_ns_;
  while (wanted && next_debug_ns_ <= t_ns) next_debug_ns_ += debug_period_ns_;
  return wanted;
}

}  // namespace overfly::server
