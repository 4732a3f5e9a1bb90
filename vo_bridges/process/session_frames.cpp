// Handles the frames of a session.
#include <utility>

#include "core/cancellable_wait.hpp"
#include "core/measure/crc32.hpp"
#include "vo_bridges/process/session.hpp"

namespace overfly::process {

namespace {

/// The session ends if a frame is not answered within this multiple of the timeout.
constexpr double kTimeoutsToGiveUp = 3.0;
/// Maximum number of parameters in a session, including the estimator's name and version.
constexpr std::size_t kParameterLimit = 4096;

Clock::time_point after_s(double seconds) {
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

Status Session::calibrate(const VoFrame& frame) {
  if (ended_) return *ended_;
  const PinholeCamera& camera = frame.intrinsics;
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  std::optional<FrameMemory> memory;
  if (local_ && hello_.takes_shared_memory) memory = FrameMemory::create(pixels);
  if (!memory && pixels > kFramePixelLimit) {
    return Error{ErrorCode::kInvalidArgument,
                 "the camera has " + std::to_string(camera.width_px) + " x " +
                     std::to_string(camera.height_px) + " = " + std::to_string(pixels) +
                     " pixels: a frame through the socket must have at most " +
                     std::to_string(kFramePixelLimit)};
  }
  memory_ = std::move(memory);
  FrameSlots slots;
  FileDescriptor descriptor;
  if (memory_) {
    slots = {FrameMemory::kSlots, memory_->slot_bytes()};
    descriptor = memory_->descriptor();
  }
  output_->note(memory_ ? "frames go through shared memory" : "frames go through the socket");
  channel_->begin_frame(pixels);
  channel_->enqueue(
      calibration_message(frame, options_.rate_hz, slots), nullptr, std::move(descriptor));
  Status ready = wait_ready(MessageType::kCalibration, after_s(options_.start_timeout_s));
  if (!ready) return end(ready.error());
  return {};
}

void Session::send(const VoFrame& frame, bool debug_wanted) {
  FrameSending sending;
  sending.crc32 = frame.image_crc32 ? *frame.image_crc32 : crc32_of(*frame.image);
  sending.debug_wanted = debug_wanted;
  if (memory_) {
    sending.in_shared_memory = true;
    sending.slot = memory_->store(*frame.image);
  }
  channel_->begin_frame(frame.image->data.size());
  if (hello_.takes_sensors) {
    if (std::string sensors = sensors_message(frame); !sensors.empty()) {
      channel_->enqueue(std::move(sensors));
    }
  }
  channel_->enqueue(frame_message(frame, sending), memory_ ? nullptr : frame.image);
  under_way_ = frame;
  under_way_->image.reset();
  under_way_->sensors = {};
  debug_under_way_ = debug_wanted;
  extra_ = {};
  sent_at_ = Clock::now();
}

Result<bool> Session::take_notice(const Message& message) {
  if (message.type == MessageType::kLog) {
    const Result<std::string> line = log_line_from(message.payload);
    if (!line) return line.error();
    output_->say(*line);
    return true;
  }
  if (message.type == MessageType::kParameters) {
    if (Status status = take_parameters(message); !status) return status.error();
    return true;
  }
  return false;
}

Status Session::take_parameters(const Message& message) {
  const auto told = parameters_from(message.payload);
  if (!told) return told.error();
  const std::lock_guard lock(mutex_);
  for (const auto& [name, value] : *told) {
    if (parameters_.size() < kParameterLimit || parameters_.contains(name)) {
      parameters_[name] = value;
    } else if (!std::exchange(parameters_overflow_noted_, true)) {
      output_->note("warning: parameter " + name + " exceeds the limit of " +
                    std::to_string(kParameterLimit) +
                    " in a session: this and later new ones are ignored");
    }
  }
  return {};
}

Status Session::take_debug(const Message& message, VoEstimate* extra) const {
  if (message.type == MessageType::kDebugImage) {
    Result<Image> image = debug_image_from(message.payload, *under_way_);
    if (!image) return image.error();
    if (debug_under_way_) extra->debug_image = std::move(image).value();
    return {};
  }
  auto points = map_points_from(message.payload, *under_way_);
  if (!points) return points.error();
  if (debug_under_way_) extra->map_points_vo = std::move(points).value();
  return {};
}

Result<std::optional<VoEstimate>> Session::wait_answer(Clock::time_point deadline) {
  for (;;) {
    Result<std::optional<Message>> message = next(deadline, kCancelPatience);
    if (!message) return message.error();
    if (!*message) return std::optional<VoEstimate>{};
    const Result<bool> noticed = take_notice(**message);
    if (!noticed) return noticed.error();
    if (*noticed) {
      if (Clock::now() >= deadline) return std::optional<VoEstimate>{};
      continue;
    }
    const MessageType type = (*message)->type;
    if (type == MessageType::kDebugImage || type == MessageType::kMapPoints) {
      if (Status status = take_debug(**message, &extra_); !status) return status.error();
      continue;
    }
    if (type != MessageType::kAnswer) {
      return Error{ErrorCode::kInternal,
                   "the estimator sent " + name_of(type) + " instead of ANSWER to frame " +
                       std::to_string(under_way_->index) + " must come"};
    }
    Result<VoEstimate> estimate = answer_from((*message)->payload, *under_way_, &figures_);
    for (const std::string& line : figures_.take_notes()) output_->note(line);
    if (!estimate)
      return estimate.error().in("ANSWER to frame " + std::to_string(under_way_->index));
    estimate->debug_image = std::move(extra_.debug_image);
    estimate->map_points_vo = std::move(extra_.map_points_vo);
    const Status usable = poses_.take(*estimate);
    for (const std::string& line : poses_.take_notes()) output_->note(line);
    if (!usable) return usable.error();
    under_way_.reset();
    return std::optional<VoEstimate>(std::move(estimate).value());
  }
}

VoFrame Session::with_unsent_samples(const VoFrame& frame) {
  VoFrame complete = frame;
  if (unsent_samples_.empty()) return complete;
  SensorSamples samples = std::exchange(unsent_samples_, {});
  append(samples, std::move(complete.sensors));
  drop_older_than(samples, kOldestSampleNs);
  complete.sensors = std::move(samples);
  return complete;
}

void Session::drop_samples_beyond_frame_limit(VoFrame& frame) {
  std::vector<ImuSample>& imu = frame.sensors.imu;
  const std::size_t most = most_imu_samples(frame, memory_.has_value());
  if (imu.size() <= most) return;
  output_->note("frame " + std::to_string(frame.index) + ": of " + std::to_string(imu.size()) +
                " inertial samples FRAME has room for the last " + std::to_string(most));
  imu.erase(imu.begin(), imu.end() - static_cast<std::ptrdiff_t>(most));
}

Result<std::optional<VoEstimate>> Session::track(const VoFrame& newest, bool debug_wanted) {
  if (ended_) return *ended_;
  VoFrame frame = with_unsent_samples(newest);
  drop_samples_beyond_frame_limit(frame);
  const auto deadline = after_s(options_.answer_timeout_s);
  if (under_way_) {
    const Result<std::optional<VoEstimate>> late = wait_answer(deadline);
    if (!late) return end(late.error());
  }
  Result<std::optional<VoEstimate>> answer = std::optional<VoEstimate>{};
  if (!under_way_) {
    send(frame, debug_wanted);
    answer = wait_answer(deadline);
    if (!answer) return end(answer.error());
  } else {
    unsent_samples_ = std::move(frame.sensors);
  }
  if (*answer) return answer;
  const double silent_s = std::chrono::duration<double>(Clock::now() - sent_at_).count();
  if (silent_s < kTimeoutsToGiveUp * options_.answer_timeout_s) return std::optional<VoEstimate>{};
  return end({ErrorCode::kTimeout,
              "the estimator hangs: frame " + std::to_string(under_way_->index) +
                  " was not answered within " + duration_text(silent_s)});
}

}  // namespace overfly::process
