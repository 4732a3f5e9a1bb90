// Runs one estimator on its own thread.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
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
  std::vector<int> cpus;  ///< for the thread and the threads that the estimator starts from it
  /// The estimator reads the image in this process: its CRC is computed after the estimator
  /// returns.
  bool in_process = true;
  /// Called with each answer at once, on the worker's thread; may be empty.
  std::function<void(const EstimateRecord&)> answered;
};

/// A slot for one frame in front of an estimator. A frame that still waits in the slot when the
/// next one arrives is dropped; its samples of sensors go with the next one. If frames are handed
/// over only when idle(), none is lost.
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
  /// Returns and clears the events since the last call, ordered by frame.
  [[nodiscard]] std::vector<EstimatorEvent> take_events();
  /// Returns and clears the log lines of the estimator, and notes about it, since the last call.
  [[nodiscard]] std::vector<std::string> take_log();
  /// Effective values, read back from the running estimator. @pre idle
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const {
    return port_->effective_parameters();
  }
  /// Resources used since it was ready. @pre idle
  [[nodiscard]] EstimatorUse use();

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
  [[nodiscard]] EstimatorEvent answer(const Waiting& waiting);
  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame);
  void hold_back(const Waiting& waiting);
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

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<VoFrame> to_prepare_;
  std::optional<Waiting> waiting_;
  bool busy_ = false;
  bool stopping_ = false;
  std::exception_ptr thrown_;       ///< by this class's own code on the worker's thread
  std::vector<std::string> notes_;  ///< about the answers
  std::vector<EstimatorEvent> events_;
  /// Drops after the frame in progress and before the waiting one.
  std::vector<EstimatorEvent> drops_;
  std::thread thread_;
};

}  // namespace overfly::server
