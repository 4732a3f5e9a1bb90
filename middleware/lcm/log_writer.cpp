#include "middleware/lcm/log_writer.hpp"

#include <lcm/eventlog.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <overfly_lcm/pose_t.hpp>
#include <overfly_lcm/sim_time_t.hpp>
#include <overfly_lcm/world_pose_t.hpp>
#include <utility>
#include <vector>

#include "middleware/lcm/messages.hpp"
#include "middleware/lcm/sensor_messages.hpp"

namespace overfly::lcm {
namespace {

constexpr std::int64_t kNsPerUs = 1000;

template <typename Message>
void put_pose(const Pose& T, Message& message) {
  std::copy_n(T.translation.data(), 3, message.position);
  std::copy_n(T.rotation.coeffs().data(), 4, message.orientation);
}

std::int8_t state_number(TrackingState state) {
  if (state == TrackingState::kTracking) return overfly_lcm::pose_t::TRACKING;
  return state == TrackingState::kLost ? overfly_lcm::pose_t::LOST
                                       : overfly_lcm::pose_t::INITIALISING;
}

class EventLogWriter final : public LogWriter {
 public:
  EventLogWriter(std::filesystem::path file, lcm_eventlog_t* log, std::int64_t epoch_utc_ns)
      : file_(std::move(file)),
        log_(log),
        epoch_utc_us_(epoch_utc_ns / kNsPerUs),
        // Differs from other runs and is not 0, like the sessions of the door.
        session_(std::max<std::int64_t>(epoch_utc_us_, 1)) {}
  ~EventLogWriter() override { lcm_eventlog_destroy(log_); }
  EventLogWriter(const EventLogWriter&) = delete;
  EventLogWriter& operator=(const EventLogWriter&) = delete;

  Status write_calibration(const std::string& prefix,
                           const std::string& camera,
                           const CameraModel& model,
                           std::int64_t stamp_ns) override {
    overfly_lcm::calibration_t message =
        calibration_message(camera, model.pinhole(), model.distortion(), {});
    message.utime = stamp_ns / kNsPerUs;
    message.session = session_;
    return write(prefix + "CALIBRATION", stamp_ns, message);
  }

  Status write_image(const std::string& prefix, const LogImage& image) override {
    overfly_lcm::image_t message =
        image_message(image.image, image.frame, image.stamp_ns, image.exposure_ns, std::nullopt);
    message.session = session_;
    message.sequence = ++sequences_[prefix];
    if (Status status = write(prefix + "IMAGE", image.stamp_ns, message); !status) return status;
    overfly_lcm::sim_time_t time{};
    time.utime = message.utime;
    time.t_ns = image.stamp_ns;
    time.session = session_;
    time.frame = image.frame;
    time.sequence = message.sequence;
    time.attempt = 1;
    return write(prefix + "TIME", image.stamp_ns, time);
  }

  Status write_truth(const std::string& prefix, const LogTruth& truth) override {
    return write(prefix + "TRUTH",
                 truth.stamp_ns,
                 truth_message(truth.frame, truth.t_ns, truth.stamp_ns, truth.T_world_camera));
  }

  Status write_samples(const std::string& prefix, const SensorSamples& samples) override {
    // The events of a log are in order of time: seeking bisects them.
    std::vector<Encoded> events;
    Status status =
        with_each_message(samples, [&](const char* name, std::int64_t available_ns, auto message) {
          Encoded event{available_ns, prefix + name, {}};
          message.session = session_;
          message.sequence = ++sequences_[event.channel];
          Status encoded = encode(event.channel, message, event.bytes);
          events.push_back(std::move(event));
          return encoded;
        });
    std::stable_sort(events.begin(), events.end(), [](const Encoded& a, const Encoded& b) {
      return a.stamp_ns < b.stamp_ns;
    });
    for (auto event = events.begin(); status && event != events.end(); ++event) {
      status = write_event(event->channel, event->stamp_ns, event->bytes);
    }
    return status;
  }

  Status write_estimate(const std::string& estimator, const EstimateSample& sample) override {
    const std::string channel = "ESTIMATE_" + estimator + "_POSE";
    overfly_lcm::pose_t message{};
    message.utime = sample.t_ns / kNsPerUs;
    message.t_ns = sample.t_ns;
    message.session = session_;
    message.frame = sample.frame;
    message.sequence = ++sequences_[channel];
    message.attempt = 1;
    message.image_received = true;
    message.image_crc32 = -1;
    message.state = state_number(sample.state);
    message.map_id = sample.map_id;
    const bool tracking = sample.state == TrackingState::kTracking;
    put_pose(tracking ? sample.T_vo_camera : Pose(), message);
    if (tracking) message.scene_depth = sample.scene_depth.value_or(0.0);
    return write(channel, sample.t_ns, message);
  }

  Status write_world_estimate(const std::string& estimator,
                              const EstimateSample& sample,
                              const Pose& T_world_camera) override {
    overfly_lcm::world_pose_t message{};
    message.utime = sample.t_ns / kNsPerUs;
    message.t_ns = sample.t_ns;
    message.frame = sample.frame;
    message.map_id = sample.map_id;
    put_pose(T_world_camera, message);
    return write("ESTIMATE_" + estimator + "_POSE_WORLD", sample.t_ns, message);
  }

  Status finish() override {
    if (std::fflush(log_->f) == 0 && std::ferror(log_->f) == 0) return {};
    return failure();
  }

 private:
  struct Encoded {
    std::int64_t stamp_ns = 0;
    std::string channel;
    std::vector<std::uint8_t> bytes;
  };

  template <typename Message>
  Status write(std::string channel, std::int64_t stamp_ns, const Message& message) {
    Status status = encode(channel, message, bytes_);
    return status ? write_event(channel, stamp_ns, bytes_) : status;
  }

  template <typename Message>
  static Status encode(const std::string& channel,
                       const Message& message,
                       std::vector<std::uint8_t>& bytes) {
    bytes.resize(static_cast<std::size_t>(message.getEncodedSize()));
    if (message.encode(bytes.data(), 0, static_cast<int>(bytes.size())) >= 0) return {};
    return Error{ErrorCode::kInternal, "cannot encode the message of " + channel};
  }

  Status write_event(std::string& channel,
                     std::int64_t stamp_ns,
                     std::vector<std::uint8_t>& bytes) {
    lcm_eventlog_event_t event{};
    event.timestamp = epoch_utc_us_ + stamp_ns / kNsPerUs;
    event.channellen = static_cast<std::int32_t>(channel.size());
    event.datalen = static_cast<std::int32_t>(bytes.size());
    event.channel = channel.data();
    event.data = bytes.data();
    if (lcm_eventlog_write_event(log_, &event) != 0) return failure();
    return {};
  }

  [[nodiscard]] Error failure() const {
    return {ErrorCode::kIo, file_.string() + ": cannot be written; is the disk full?"};
  }

  std::filesystem::path file_;
  lcm_eventlog_t* log_;
  std::int64_t epoch_utc_us_;
  std::int64_t session_;
  std::map<std::string, std::int64_t> sequences_;  ///< of images by prefix, of samples by channel
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

Result<std::unique_ptr<LogWriter>> LogWriter::create(const std::filesystem::path& file,
                                                     std::int64_t epoch_utc_ns) {
  lcm_eventlog_t* const log = lcm_eventlog_create(file.c_str(), "w");
  if (log == nullptr) return Error{ErrorCode::kIo, file.string() + ": cannot be created"};
  return std::unique_ptr<LogWriter>(std::make_unique<EventLogWriter>(file, log, epoch_utc_ns));
}

}  // namespace overfly::lcm
