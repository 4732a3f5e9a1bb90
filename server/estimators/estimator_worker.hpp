// One estimator at work on a thread of its own.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "server/record/estimator_event.hpp"
#include "server/timing/run_clock.hpp"
#include "vo_bridges/pose_intake.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::engine {

struct EstimatorWorkerOptions {
  double debug_hz = 0.0;  ///< rate of debug images, 0 = none
  /// Frames taken a second at most, as if each took that long; 0 = as fast as the estimator is.
  double throttle_hz = 0.0;
  std::vector<int> cpus;  ///< of the thread, and those that the estimator starts from it
  /// The estimator looks at our own image: its CRC is computed when it is done with it.
  bool in_process = true;
};

/// A slot for one frame in front of an estimator: a frame that still waits there when the next one
/// comes is dropped. Handing over a frame only when idle() makes it lossless.
class EstimatorWorker {
 public:
  EstimatorWorker(std::unique_ptr<VoPort> port, EstimatorWorkerOptions options, RunClock& clock);
  /// Waits for the frame at work, forgets the one in the slot.
  ~EstimatorWorker();
  EstimatorWorker(const EstimatorWorker&) = delete;
  EstimatorWorker& operator=(const EstimatorWorker&) = delete;

  /// Makes the estimator ready for a camera, on its thread: once, and `wait_until_idle` before the
  /// first frame. A failure is told with that frame.
  /// @param first  as VoPort::prepare's
  void prepare(VoFrame first);
  void submit(VoFrame frame);
  /// Waits until no frame is at work or waiting. This and take_events() throw what stopped the
  /// worker's own thread (too little memory); what the estimator throws is its crash.
  void wait_until_idle();
  /// Takes what happened since the last call, ordered by frame.
  [[nodiscard]] std::vector<EstimatorEvent> take_events();
  /// Takes the lines that the estimator said, or that were noted of it, since the last call.
  [[nodiscard]] std::vector<std::string> take_log();
  /// Read back from the running estimator. @pre idle
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const {
    return port_->effective_parameters();
  }
  /// What it has used since it was ready. @pre idle
  [[nodiscard]] EstimatorUse use();

 private:
  struct Waiting {
    VoFrame frame;
    std::int64_t handed_over_ns = 0;
  };
  void work();
  void make_ready(std::unique_lock<std::mutex>& lock);
  void answer_waiting(std::unique_lock<std::mutex>& lock);
  /// Throws what stopped this worker's thread from answering, once. Under the lock.
  void rethrow_failure();
  [[nodiscard]] EstimatorEvent answer(const Waiting& waiting);
  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame);
  /// Errors: kInternal after too many answers in a row without a usable pose.
  [[nodiscard]] Status judge(VoEstimate& estimate);
  void hold_back(const Waiting& waiting);
  void choose_debug(std::int64_t t_ns);

  std::unique_ptr<VoPort> port_;
  const EstimatorWorkerOptions options_;
  RunClock& clock_;
  std::int64_t ready_ns_ = 0;
  double cpu_to_get_ready_s_ = 0.0;        ///< of the estimator's process, until then
  std::optional<ResourceUse> last_known_;  ///< an estimator that has ended tells no more
  std::optional<Error> failure_;           ///< to get ready
  std::int64_t debug_period_ns_ = 0;
  std::int64_t next_debug_ns_ = 0;
  std::int64_t free_at_ns_ = 0;  ///< of a throttled estimator
  double cpu_s_ = 0.0;           ///< of our thread, in the estimator
  std::int64_t answers_ = 0;
  bool crashed_ = false;
  PoseIntake poses_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<VoFrame> to_prepare_;
  std::optional<Waiting> waiting_;
  bool busy_ = false;
  bool stopping_ = false;
  std::exception_ptr thrown_;       ///< by our own lines on the worker's thread
  std::vector<std::string> notes_;  ///< of ours about its answers
  std::vector<EstimatorEvent> events_;
  std::vector<EstimatorEvent> drops_;  ///< after the frame at work, before the one that waits
  std::thread thread_;
};

}  // namespace overfly::engine
