// Runs one estimator on its own thread.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "server/estimators/estimator_driver.hpp"
#include "server/record/estimator_event.hpp"
#include "server/timing/run_clock.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::server {

struct EstimatorWorkerOptions {
  double debug_hz = 0.0;  ///< rate of debug images, 0 = none
  /// Maximum number of frames taken per second, as if each took that long; 0 = no limit.
  double throttle_hz = 0.0;
  /// Number of frames that may be handed over ahead of the one that the estimator takes next, for a
  /// flight that does not run in real time; 0 = none, a single slot.
  std::size_t frames_ahead = 0;
  std::vector<int> cpus;  ///< for the thread and the threads that the estimator starts from it
  /// The estimator reads the image in this process: its CRC is computed after the estimator
  /// returns.
  bool in_process = true;
  /// Ends the waiting of an estimator that is held to its rate; may be null, must outlive the
  /// worker.
  const std::atomic<bool>* cancel = nullptr;
  /// Called with each answer at once, on the worker's thread; may be empty.
  std::function<void(const EstimateRecord&)> answered;
};

/// A queue of frames in front of an estimator, in real time with a single place. If a frame arrives
/// when all places are taken, the newest waiting frame is dropped; its samples of sensors go with
/// the next one. If frames are handed over only while there is a place, none is lost.
///
/// With frames ahead, answers and log lines belong to their frames however far the estimator is:
/// take_events(frame) gives the same at each call, and latencies do not include the waiting.
class EstimatorWorker {
 public:
  EstimatorWorker(std::unique_ptr<VoPort> port, EstimatorWorkerOptions options, RunClock& clock);
  /// Waits for the frame in progress and discards the one in the slot.
  ~EstimatorWorker();
  EstimatorWorker(const EstimatorWorker&) = delete;
  EstimatorWorker& operator=(const EstimatorWorker&) = delete;

  /// Prepares the estimator for a camera, on its thread. Call it once, then `wait_until_idle`
  /// before the first frame. A failure is reported with that frame.
  /// @param first  as VoPort::prepare's
  void prepare(VoFrame first);
  void submit(VoFrame frame);
  /// Waits until no frame is in progress or waiting. This and take_events() rethrow the exception
  /// that stopped the worker's thread (out of memory). An exception thrown by the estimator counts
  /// as its crash.
  void wait_until_idle();
  /// Waits until no frame up to this one is in progress or waiting. Rethrows as wait_until_idle().
  void wait_until_answered(std::int64_t frame);
  /// Whether wait_until_answered(frame) would return at once.
  [[nodiscard]] bool answered(std::int64_t frame) const;
  /// Removes the waiting frames after this one, without an event.
  void forget_after(std::int64_t frame);
  /// Returns and clears the events up to a frame since the last call, ordered by frame.
  [[nodiscard]] std::vector<EstimatorEvent> take_events(std::int64_t frame = kAllFrames);
  /// Returns and clears the log lines of the estimator, and notes about it, since the last call;
  /// those that belong to an event are in EstimatorEvent::log.
  [[nodiscard]] std::vector<std::string> take_log();
  /// Effective values, read back from the running estimator. @pre idle
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const {
    return port_->effective_parameters();
  }
  /// Resources used since it was ready. @pre idle
  [[nodiscard]] EstimatorUse use();

  static constexpr std::int64_t kAllFrames = std::numeric_limits<std::int64_t>::max();

 private:
  struct Waiting {
    VoFrame frame;
    std::int64_t handed_over_ns = 0;
  };
  void work();
  void make_ready(std::unique_lock<std::mutex>& lock);
  void answer_waiting(std::unique_lock<std::mutex>& lock);
  /// Rethrows, once, the exception that stopped this worker's thread. @pre the lock is held
  void rethrow_failure();
  /// @pre the lock is held
  [[nodiscard]] bool has_answered(std::int64_t frame) const;
  /// The estimator's log lines and the notes about it. @pre the lock is held
  [[nodiscard]] std::vector<std::string> take_lines();
  [[nodiscard]] EstimatorEvent answer(const Waiting& waiting);
  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame);
  /// False if the run was stopped meanwhile.
  [[nodiscard]] bool hold_back(const Waiting& waiting);
  /// Whether a frame gets a debug image, by the rate of them.
  [[nodiscard]] bool takes_debug(std::int64_t t_ns);

  std::unique_ptr<VoPort> port_;
  EstimatorDriver driver_;
  const EstimatorWorkerOptions options_;
  RunClock& clock_;
  std::int64_t ready_ns_ = 0;
  std::int64_t debug_period_ns_ = 0;
  std::int64_t next_debug_ns_ = 0;
  std::int64_t free_at_ns_ = 0;  ///< for a throttled estimator
  double cpu_s_ = 0.0;           ///< of the worker's thread, inside the estimator
  std::int64_t answers_ = 0;
  bool crashed_ = false;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<VoFrame> to_prepare_;
  std::deque<Waiting> waiting_;  ///< in the order of their frames
  bool busy_ = false;
  std::int64_t frame_in_progress_ = 0;  ///< while busy
  std::int64_t idle_from_ns_ = 0;       ///< end of the last frame
  bool stopping_ = false;
  std::exception_ptr thrown_;       ///< by this class's own code on the worker's thread
  std::vector<std::string> notes_;  ///< about the answers
  std::vector<EstimatorEvent> events_;
  /// Drops after the frame in progress and before the last waiting one.
  std::vector<EstimatorEvent> drops_;
  std::thread thread_;
};

}  // namespace overfly::server
