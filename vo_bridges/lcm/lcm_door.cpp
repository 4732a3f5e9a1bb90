#include "vo_bridges/lcm/lcm_door.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

#include "core/cancellable_wait.hpp"
#include "vo_bridges/lcm/lcm_link.hpp"
#include "vo_bridges/lcm/lcm_option_check.hpp"
#include "vo_bridges/pose_intake.hpp"

namespace overfly {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::nanoseconds;

/// Interval at which the calibration is published until an estimator responds.
constexpr std::chrono::milliseconds kAnnouncePeriod{250};
/// Interval at which a missing answer is requested again.
constexpr std::chrono::milliseconds kAskPeriod{200};
/// Maximum number of times an image is sent in lockstep.
constexpr int kMostSends = 5;
/// Number of consecutive frames without any message after which the estimator is given up.
constexpr int kMostSilentFrames = 5;

nanoseconds from_seconds(double time_s) {
  return std::chrono::duration_cast<nanoseconds>(std::chrono::duration<double>(time_s));
}

/// Transport errors so far, by counter name.
std::map<std::string, std::int64_t> faults_of(LcmLink& link) {
  const AnswerCounts counts = link.answers().counts();
  return {{"answers_late", counts.late},
          {"answers_duplicate", counts.duplicate},
          {"answers_unknown", counts.unknown + link.outdated()},
          {"answers_out_of_order", counts.out_of_order},
          {"messages_refused", link.far_end().refused()}};
}

class LcmEstimator final : public VoPort {
 public:
  LcmEstimator(std::unique_ptr<LcmLink> link,
               LcmEstimatorOptions options,
               bool hears,
               std::shared_ptr<LcmClaim> claim)
      : claim_(std::move(claim)),
        link_(std::move(link)),
        options_(std::move(options)),
        hears_(hears) {}

  [[nodiscard]] std::string type() const override { return "lcm"; }
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override {
    return link_->far_end().parameters();
  }
  [[nodiscard]] Status prepare(const VoFrame& first) override;
  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame) override;
  void set_debug(bool wanted) override { link_->set_debug(wanted); }
  [[nodiscard]] std::vector<std::string> take_log() override { return link_->far_end().take_log(); }
  [[nodiscard]] std::optional<ResourceUse> resource_use() const override {
    return link_->far_end().resource_use();
  }

 private:
  using Answer = std::optional<VoEstimate>;

  Status begin_session(const VoFrame& frame);
  Result<Answer> ask(const VoFrame& frame);
  /// Publishes the frame for the first time, after the samples since the last published one.
  Status send(const VoFrame& frame);
  Result<bool> wait_for_estimator(Clock::time_point deadline);
  Result<Answer> wait_for_answer(const VoFrame& frame, Clock::time_point deadline);
  Error no_estimator() const;
  VoEstimate complete(Answer answer, const VoFrame& frame);
  /// Marks the estimator as failed permanently, unless the error is a cancellation.
  Error ended_by(const Error& error);

  const std::shared_ptr<LcmClaim>
      claim_;  ///< first, so that it is destroyed last; null for a test's node
  std::unique_ptr<LcmLink> link_;
  const LcmEstimatorOptions options_;
  const bool hears_;  ///< false: no messages can be received from this network
  PoseIntake poses_;
  std::optional<VoFrame> previous_;
  SensorSamples unsent_samples_;
  std::optional<Error> gone_;
  Clock::time_point start_deadline_;
  bool in_session_ = false;
  bool prepared_ = false;  ///< the session has started but had no frame
  bool waiting_told_ = false;
  int silent_frames_ = 0;
  std::int64_t images_lost_ = 0;
  std::int64_t images_lost_told_ = 0;
  std::map<std::string, std::int64_t> faults_told_;
  bool had_pose_ = false;
  int map_id_ = 0;
};

Result<VoEstimate> LcmEstimator::track(const VoFrame& frame) {
  const VoFrame* const previous = previous_ ? &*previous_ : nullptr;
  if (Status status = validate_vo_frame(frame, previous); !status) return status.error();
  if (gone_) return *gone_;
  previous_ = frame;
  previous_->image.reset();  // its size stays in the intrinsics
  previous_->sensors = {};
  append(unsent_samples_, SensorSamples(frame.sensors));
  drop_older_than(unsent_samples_, kOldestSampleNs);
  Result<Answer> answer = ask(frame);
  if (!answer) return ended_by(answer.error());
  VoEstimate estimate = complete(std::move(*answer), frame);
  const Status usable = poses_.take(estimate);
  for (const std::string& line : poses_.take_notes()) link_->far_end().say(line);
  if (!usable) return ended_by(usable.error());
  return estimate;
}

Error LcmEstimator::ended_by(const Error& error) {
  if (error.code != ErrorCode::kCancelled) gone_ = error;
  return error;
}

/// Waits in real time as in lockstep, because the flight's clock has not started.
Status LcmEstimator::prepare(const VoFrame& first) {
  if (gone_) return *gone_;
  if (in_session_) return {};
  if (Status status = begin_session(first); !status) return ended_by(status.error());
  prepared_ = true;
  if (!hears_) return {};
  const Result<bool> ready = wait_for_estimator(start_deadline_);
  return ready ? Status() : Status(ended_by(ready.error()));
}

Status LcmEstimator::begin_session(const VoFrame& frame) {
  std::map<std::string, std::string> parameters;
  for (const auto& [name, value] : options_.parameters) parameters[name] = text_of(value);
  overfly_lcm::calibration_t calibration =
      lcm::calibration_message(frame.camera_id, frame.intrinsics, frame.distortion, parameters);
  calibration.utime = frame.t_ns / 1000;
  calibration.lockstep = options_.lockstep ? 1 : 0;
  link_->begin(std::move(calibration));
  start_deadline_ = Clock::now() + from_seconds(options_.start_timeout_s);
  in_session_ = true;
  return link_->announce();
}

/// Errors: the estimator has failed permanently. Empty: no answer to this frame.
Result<LcmEstimator::Answer> LcmEstimator::ask(const VoFrame& frame) {
  if (!in_session_) {
    if (Status status = begin_session(frame); !status) return status.error();
  } else if (std::exchange(prepared_, false)) {
    start_deadline_ = Clock::now() + from_seconds(options_.start_timeout_s);
  }
  if (!hears_) {
    if (Status status = send(frame); !status) return status.error();
    return Answer{};
  }
  const auto patience = Clock::now() + from_seconds(options_.answer_timeout_s);
  const Result<bool> ready =
      wait_for_estimator(options_.lockstep ? start_deadline_ : std::min(start_deadline_, patience));
  if (!ready) return ready.error();
  if (!*ready) return Answer{};
  const auto answer_deadline = Clock::now() + from_seconds(options_.answer_timeout_s);
  const bool starting = options_.lockstep && !had_pose_ && silent_frames_ == 0;
  return wait_for_answer(frame,
                         starting ? std::max(start_deadline_, answer_deadline) : answer_deadline);
}

Status LcmEstimator::send(const VoFrame& frame) {
  if (Status status = link_->send(std::exchange(unsent_samples_, {})); !status) return status;
  return link_->send(frame);
}

Result<bool> LcmEstimator::wait_for_estimator(Clock::time_point deadline) {
  const auto hear = [&](nanoseconds timeout) {
    return link_->far_end().wait_until_ready(link_->session(), timeout);
  };
  while (!wait_unless_cancelled(
      options_.cancel, std::min(Clock::now() + kAnnouncePeriod, deadline), hear)) {
    if (is_cancelled(options_.cancel)) return cancelled("an estimator on " + options_.url);
    if (!std::exchange(waiting_told_, true)) {
      link_->far_end().say("waits for an estimator that answers " + options_.channel_prefix +
                           "CALIBRATION on " + options_.url);
    }
    if (Clock::now() >= start_deadline_) return no_estimator();
    if (Clock::now() >= deadline) return false;
    if (Status status = link_->announce(); !status) return status.error();
  }
  return true;
}

Result<LcmEstimator::Answer> LcmEstimator::wait_for_answer(const VoFrame& frame,
                                                           Clock::time_point deadline) {
  if (Status status = send(frame); !status) return status.error();
  int sends = 1;
  bool stopping = false;
  while (Clock::now() < deadline) {
    Answer answer = wait_unless_cancelled(
        options_.cancel,
        std::min(Clock::now() + (stopping ? kCancelPatience : kAskPeriod), deadline),
        [&](nanoseconds timeout) { return link_->answers().wait(frame.t_ns, timeout); },
        kCancelPatience);
    Status sent;
    if (!answer && is_cancelled(options_.cancel)) {
      if (std::exchange(stopping, true)) {
        link_->answers().give_up(frame.t_ns);
        return cancelled("the answer to frame " + std::to_string(frame.index));
      }
    } else if (!answer) {
      sent = link_->ask_again();
    } else if (!answer->counters.contains(kImageLost)) {
      silent_frames_ = 0;
      return answer;
    } else {
      ++images_lost_;
      silent_frames_ = 0;
      if (!options_.lockstep || sends == kMostSends) return Answer{};
      ++sends;
      sent = link_->send(frame);
    }
    if (!sent) return sent.error();
  }
  link_->answers().give_up(frame.t_ns);
  link_->far_end().say("no answer to frame " + std::to_string(frame.index) + " in time");
  if (++silent_frames_ < kMostSilentFrames) return Answer{};
  return Error{ErrorCode::kInternal,
               "the estimator on " + options_.url + " left " + std::to_string(kMostSilentFrames) +
                   " frames in a row unanswered, the last one frame " +
                   std::to_string(frame.index)};
}

Error LcmEstimator::no_estimator() const {
  return {ErrorCode::kInternal,
          "no estimator on " + options_.url + ": nobody answered " + options_.channel_prefix +
              "CALIBRATION by " + options_.channel_prefix +
              "STATUS within start_timeout_s = " + std::to_string(options_.start_timeout_s) +
              "; is it running, with the same URL and prefix? `overfly doctor` checks the network"};
}

VoEstimate LcmEstimator::complete(Answer answer, const VoFrame& frame) {
  VoEstimate estimate;
  if (answer) {
    estimate = std::move(*answer);
    had_pose_ = had_pose_ || estimate.sample.state == TrackingState::kTracking;
    map_id_ = std::max(map_id_, estimate.sample.map_id);
  } else {
    estimate.sample.state = had_pose_ ? TrackingState::kLost : TrackingState::kInitialising;
    estimate.counters["unanswered"] = 1.0;
  }
  estimate.sample.frame = frame.index;
  estimate.sample.t_ns = frame.t_ns;
  estimate.sample.map_id = map_id_;
  const std::int64_t lost = images_lost_ - std::exchange(images_lost_told_, images_lost_);
  if (lost > 0) estimate.counters[kImageLost] = static_cast<double>(lost);
  for (const auto& [name, count] : faults_of(*link_)) {
    const std::int64_t told = std::exchange(faults_told_[name], count);
    if (count > told) estimate.counters[name] = static_cast<double>(count - told);
  }
  return estimate;
}

}  // namespace

Result<std::unique_ptr<VoPort>> create_lcm_estimator_on(std::shared_ptr<lcm::Node> node,
                                                        const LcmEstimatorOptions& options,
                                                        std::shared_ptr<LcmClaim> claim) {
  const Result<lcm::Url> url = check_lcm_options(options);
  if (!url) return url.error();
  const bool hears = url->provider != "file";
  Result<std::unique_ptr<LcmLink>> link =
      LcmLink::open(std::move(node), options.channel_prefix, hears);
  if (!link) return link.error();
  return std::unique_ptr<VoPort>(
      std::make_unique<LcmEstimator>(std::move(*link), options, hears, std::move(claim)));
}

}  // namespace overfly
