#include "vo_bridges/ros1/ros1_session.hpp"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "core/cancellable_wait.hpp"
#include "middleware/ros1/messages.hpp"
#include "vo_bridges/ros1/ros1_option_check.hpp"
#include "vo_bridges/ros1/ros1_parameters.hpp"

namespace overfly::ros1 {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kSecondNs = 1'000'000'000;
/// Timeout of each call to the master or a node when looking up the node's process.
constexpr std::chrono::milliseconds kLookTimeout{500};
/// ROS stores seconds in 32 bits.
constexpr std::int64_t kEndOfTimeNs = (std::int64_t{1} << 32U) * kSecondNs;

AnswerPatience::Clock::duration seconds(double value) {
  return std::chrono::duration_cast<AnswerPatience::Clock::duration>(
      std::chrono::duration<double>(value));
}

/// True for 1, 10, 100, ...: events of every frame must not fill the log.
bool worth_a_line(std::int64_t count) {
  while (count >= 10 && count % 10 == 0) count /= 10;
  return count == 1;
}

}  // namespace

Session::Session(Node& node, const Ros1EstimatorOptions& options)
    : node_(node),
      options_(options),
      patience_(options.lockstep, seconds(options.answer_timeout_s)),
      offset_ns_(kSecondNs) {
  node_.add_log(log_);
}

template <typename Condition>
bool Session::wait_until(Clock::time_point end, const Condition& done) const {
  while (!done()) {
    if (Clock::now() >= end || is_cancelled(options_.cancel)) return false;
    std::this_thread::sleep_for(5ms);  // roscpp provides no event for this
  }
  return true;
}

Result<std::int64_t> Session::stamp_of(const VoFrame& frame) {
  const auto bad = [&](const std::string& what, std::int64_t value) {
    return Error{ErrorCode::kInvalidArgument,
                 what + " of frame " + std::to_string(frame.index) + " = " + std::to_string(value) +
                     " ns: must be within " + std::to_string(kEndOfTimeNs / kSecondNs) +
                     " s of 0, as ROS counts seconds in 32 bits"};
  };
  if (frame.t_ns < -kEndOfTimeNs || frame.t_ns >= kEndOfTimeNs) return bad("stamp", frame.t_ns);
  if (!previous_) offset_ns_ = std::max(offset_ns_, kSecondNs - frame.t_ns);
  const std::int64_t stamp_ns = frame.t_ns + offset_ns_;
  if (stamp_ns >= kEndOfTimeNs) return bad("stamp on ROS", stamp_ns);
  return stamp_ns;
}

Status Session::begin(Clock::time_point end) {
  auto topics = Topics::open(node_, options_, handlers(), log_);
  if (!topics) return topics.error();
  topics_ = std::move(*topics);
  node_use_ = std::make_unique<NodeUse>(
      node_.master(), node_.name(), topics_->image_topic(), topics_->pose_topic());
  watch_ = std::make_unique<MasterWatch>(
      node_.master(),
      node_.name(),
      topics_->registrations(),
      log_,
      [this](const std::atomic<bool>& cancel) { node_use_->look(kLookTimeout, &cancel); });
  const bool listens = wait_until(end, [&] {
    // Some nodes subscribe to the calibration before the images.
    return topics_->somebody_sees_images() || topics_->somebody_sees_calibration();
  });
  if (listens) return {};
  if (is_cancelled(options_.cancel)) return cancelled("a subscriber of " + options_.image_topic);
  return Error{ErrorCode::kNotFound,
               "nobody subscribes to " + options_.image_topic + " at the ROS master " +
                   node_.master().uri() + " within " + std::to_string(options_.start_timeout_s) +
                   " s: start the estimator's node, or set image_topic to what it listens to"};
}

Status Session::await_readiness(const VoFrame& frame, std::int64_t stamp_ns) {
  topics_->publish_calibration(frame, stamp_ns);
  const auto end = Clock::now() + seconds(options_.start_timeout_s);
  (void)wait_until(
      end, [&] { return topics_->somebody_sees_images() && topics_->somebody_tells_poses(); });
  // Wait a moment longer for optional connections, which are made after the required ones.
  (void)wait_until(Clock::now() + 500ms, [&] {
    return topics_->somebody_sees_calibration() && topics_->somebody_draws_debug_images();
  });
  if (is_cancelled(options_.cancel)) return cancelled("the estimator's node to be ready");
  if (topics_->somebody_tells_poses()) {
    node_use_->look(kLookTimeout, options_.cancel);
  } else {
    log_->add("nobody publishes poses on " +
              (options_.pose_type == Ros1PoseType::kTf ? "/tf" : options_.pose_topic) + " yet");
  }
  return {};
}

TopicHandlers Session::handlers() {
  return {[this](std::int64_t stamp_ns,
                 const std::optional<Pose>& pose,
                 std::span<const double> covariance) { take_pose(stamp_ns, pose, covariance); },
          [this](const ImageMessage::ConstPtr& image) {
            if (debug_) debug_images_.deliver(image);
          }};
}

void Session::take_pose(std::int64_t stamp_ns,
                        const std::optional<Pose>& published,
                        std::span<const double> covariance) {
  VoEstimate answer;
  if (published) {
    answer.sample.state = TrackingState::kTracking;
    answer.sample.T_vo_camera = T_vo_camera_from(*published, options_);
    answer.covariance = covariance_from(*published, covariance, options_);
  } else {
    answer.pose_fault = "the pose is not finite, or its quaternion's norm is not 1";
  }
  patience_.answered(stamp_ns, Clock::now());
  if (!answers_.deliver(stamp_ns, std::move(answer))) report_strays();
}

void Session::report_strays() {
  const AnswerCounts counts = answers_.counts();
  const auto report = [this](std::int64_t now, std::int64_t before, const char* what) {
    if (now != before && worth_a_line(now)) log_->add(std::to_string(now) + what);
  };
  report(counts.late, reported_.late, " poses arrived too late for their frames");
  report(counts.duplicate, reported_.duplicate, " poses were duplicates for their frames");
  report(counts.unknown,
         reported_.unknown,
         " poses have a stamp of no frame: it must be that of the image");
  reported_ = counts;
}

Error Session::gone() const {
  std::string message =
      "nobody subscribes to " + options_.image_topic + " any more: the estimator's node has ended";
  if (!watch_->master_answers()) {
    message += "; the ROS master at " + node_.master().uri() + " does not answer either";
  }
  return {ErrorCode::kInternal, message};
}

Status Session::await_estimator() {
  if (!Node::alive()) {
    return Error{ErrorCode::kInternal, "the ROS node of this process was shut down"};
  }
  if (topics_->somebody_sees_images()) {
    alone_since_.reset();
    return {};
  }
  if (!alone_since_) alone_since_ = Clock::now();
  // Without a master no node can reconnect.
  if (!watch_->master_answers()) return gone();
  if (options_.lockstep) {
    const auto end = Clock::now() + seconds(options_.answer_timeout_s);
    if (!wait_until(end, [&] { return topics_->somebody_sees_images(); })) {
      if (is_cancelled(options_.cancel)) return cancelled("the estimator's node to be back");
      return gone();
    }
    alone_since_.reset();
    return {};
  }
  if (Clock::now() - *alone_since_ > seconds(options_.start_timeout_s)) return gone();
  return {};
}

Status Session::prepare(const VoFrame& first) {
  if (ready_) return {};
  const Result<std::int64_t> stamp_ns = stamp_of(first);
  if (!stamp_ns) return stamp_ns.error();
  Status status = await_readiness(first, *stamp_ns);
  ready_ = status.ok();
  return status;
}

Result<VoEstimate> Session::track(const VoFrame& frame) {
  const VoFrame* const previous = previous_ ? &*previous_ : nullptr;
  if (Status status = validate_vo_frame(frame, previous); !status) return status.error();
  const Result<std::int64_t> stamp_ns = stamp_of(frame);
  if (!stamp_ns) return stamp_ns.error();
  if (Status status = prepare(frame); !status) return status.error();
  if (!ended_) {
    if (Status status = await_estimator(); !status) {
      if (status.error().code == ErrorCode::kCancelled) return status.error();
      ended_ = status.error();
    }
  }
  if (ended_) return *ended_;
  previous_ = frame;
  previous_->image.reset();  // its size stays in the intrinsics
  previous_->sensors = {};
  return exchange(frame, *stamp_ns);
}

Result<VoEstimate> Session::exchange(const VoFrame& frame, std::int64_t stamp_ns) {
  answers_.expect(stamp_ns);
  auto wait = patience_.begin(stamp_ns, Clock::now());
  if (alone_since_) wait = 0ns;
  topics_->publish(frame, stamp_ns);
  std::optional<VoEstimate> answer = wait_unless_cancelled(
      options_.cancel,
      Clock::now() + wait,
      [&](std::chrono::nanoseconds timeout) { return answers_.wait(stamp_ns, timeout); },
      kCancelPatience);
  if (!answer) answer = answers_.take(stamp_ns, 0ns);
  if (!answer && is_cancelled(options_.cancel)) {
    return cancelled("the pose of frame " + std::to_string(frame.index));
  }
  VoEstimate estimate;
  if (answer) {
    estimate = std::move(*answer);
  } else {
    patience_.gave_up();
    estimate.counters["unanswered"] = 1.0;
    estimate.sample.state = tracked_ ? TrackingState::kLost : TrackingState::kInitialising;
  }
  estimate.sample.frame = frame.index;
  estimate.sample.t_ns = frame.t_ns;
  const Status usable = poses_.take(estimate);
  for (const std::string& line : poses_.take_notes()) log_->add(line);
  if (!usable) {
    ended_ = usable.error();
    return *ended_;
  }
  if (estimate.sample.state == TrackingState::kTracking) {
    tracked_ = true;
    topics_->publish_estimate(estimate.sample.T_vo_camera, stamp_ns);
  }
  if (debug_) add_debug_image(frame, stamp_ns, estimate);
  return estimate;
}

void Session::add_debug_image(const VoFrame& frame, std::int64_t stamp_ns, VoEstimate& estimate) {
  if (options_.debug_image_topic.empty()) return;
  // Without lockstep a debug image is not worth a delay.
  const std::chrono::milliseconds patience = options_.lockstep ? DebugImages::kPatience : 0ms;
  const ImageMessage::ConstPtr message = debug_images_.take(stamp_ns, patience, options_.cancel);
  if (!message) return;
  Result<Image> image =
      rgb_image_from(*message, frame.intrinsics.width_px, frame.intrinsics.height_px);
  if (image) {
    estimate.debug_image = std::move(*image);
  } else {
    log_->add("debug image: " + image.error().message);
  }
}

std::map<std::string, std::string> Session::effective_parameters() const {
  std::map<std::string, std::string> all = effective(options_);
  if (!options_.parameter_namespace.empty() && watch_->master_answers()) {
    all.merge(read_parameters(options_.parameter_namespace));
  }
  return all;
}

}  // namespace overfly::ros1
