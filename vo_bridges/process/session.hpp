// Communication with one estimator, from start to end.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "vo_bridges/pose_intake.hpp"
#include "vo_bridges/process/child/child_process.hpp"
#include "vo_bridges/process/link/channel.hpp"
#include "vo_bridges/process/link/frame_memory.hpp"
#include "vo_bridges/process/link/listener.hpp"
#include "vo_bridges/process/link/messages.hpp"
#include "vo_bridges/process/options.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::process {

/// Rounded to one decimal: "0.3 s".
[[nodiscard]] std::string duration_text(double seconds);

/// Not thread-safe, except for the three methods that say so. The first error ends the session: the
/// child is killed, and every later call fails with the same error. A frame or camera that cannot
/// be sent (kInvalidArgument) does not end it.
class Session {
 public:
  /// Starts the child or waits for the estimator, performs the handshake, and waits until it is
  /// ready.
  /// Errors: as create_process_estimator.
  static Result<std::unique_ptr<Session>> open(const ProcessEstimatorOptions& options);
  /// Sends STOP, waits for a short time, then kills the child.
  ~Session();

  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Sends the camera and waits until the estimator is ready for frames; needs no image.
  [[nodiscard]] Status calibrate(const VoFrame& frame);
  /// Sends the frame and waits for its answer; empty on timeout. The next call waits for the
  /// pending answer before it sends its frame.
  [[nodiscard]] Result<std::optional<VoEstimate>> track(const VoFrame& frame, bool debug_wanted);

  /// Thread-safe.
  [[nodiscard]] std::map<std::string, std::string> parameters() const;
  [[nodiscard]] std::vector<std::string> take_log() { return output_->take_lines(); }
  [[nodiscard]] std::optional<ResourceUse> resource_use() const;

 private:
  explicit Session(const ProcessEstimatorOptions& options) : options_(options) {}
  [[nodiscard]] Status connect(Listener listener, Clock::time_point deadline);
  [[nodiscard]] Status greet(Clock::time_point deadline);
  /// As Channel::next; returns kCancelled `patience` after a cancellation.
  [[nodiscard]] Result<std::optional<Message>> next(Clock::time_point deadline,
                                                    std::chrono::milliseconds patience = {});
  /// Waits until READY confirms `done`.
  [[nodiscard]] Status wait_ready(MessageType done, Clock::time_point deadline);
  /// Waits for the answer to the current frame; empty at the deadline.
  [[nodiscard]] Result<std::optional<VoEstimate>> wait_answer(Clock::time_point deadline);
  void send(const VoFrame& frame, bool debug_wanted);
  /// The frame with the samples of frames that were not sent.
  [[nodiscard]] VoFrame with_unsent_samples(const VoFrame& frame);
  void drop_samples_beyond_frame_limit(VoFrame& frame);
  /// Handles a message that may arrive at any time. @return whether it was one
  [[nodiscard]] Result<bool> take_notice(const Message& message);
  [[nodiscard]] Status take_parameters(const Message& message);
  [[nodiscard]] Status take_debug(const Message& message, VoEstimate* extra) const;
  [[nodiscard]] std::string described() const;
  /// Ends the session for this reason; the error includes how the child ended and its last output.
  Error end(const Error& why);

  ProcessEstimatorOptions options_;
  std::shared_ptr<ChildOutput> output_ = std::make_shared<ChildOutput>();
  std::unique_ptr<ChildProcess> child_;
  std::optional<Channel> channel_;
  int peer_pid_ = 0;
  bool local_ = false;
  bool debug_under_way_ = false;
  bool parameters_overflow_noted_ = false;
  EstimatorHello hello_;
  SensorSamples unsent_samples_;  // of frames that were not sent
  std::optional<FrameMemory> memory_;
  std::optional<VoFrame> under_way_;  // sent but not answered; without its image
  VoEstimate extra_;                  // its debug image and map points
  FigureIntake figures_;
  PoseIntake poses_;
  Clock::time_point sent_at_;
  std::optional<Clock::time_point> cancelled_at_;
  std::optional<Error> ended_;
  mutable std::mutex mutex_;
  std::map<std::string, std::string> parameters_;
};

}  // namespace overfly::process
