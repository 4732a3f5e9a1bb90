#include "flight/playback/topics/topic_outputs.hpp"

#include <algorithm>
#include <optional>
#include <thread>
#include <utility>

#include "core/time.hpp"
#include "middleware/lcm/flight_publisher.hpp"
#include "middleware/ros1/flight_publisher.hpp"

namespace overfly::flight::playback {
namespace {

constexpr std::int64_t kNsPerMicro = 1000;
constexpr int kMessagesOfAMoment = 3;  ///< pose, GPS, IMU

/// What both have in common: moments at their times, and nothing to hear.
class MomentsOutput : public PlaybackOutput {
 public:
  void wait(TimePoint /*now*/, std::chrono::milliseconds patience) override {
    std::this_thread::sleep_for(patience);
  }
  Result<std::optional<std::int64_t>> next_us() final {
    if (ended_ || next_ >= moments_.count()) return std::optional<std::int64_t>();
    return std::optional(next_ * moments_.period_ns() / kNsPerMicro);
  }
  Status send(PlaybackSummary& summary) final {
    const Result<std::optional<FlightMoment>> moment = moments_.at(next_++);
    if (!moment) return moment.error();
    if (*moment) return publish(**moment, summary);
    ended_ = true;
    return {};
  }
  Status seek(std::int64_t t_us) final {
    const std::int64_t period_ns = moments_.period_ns();
    next_ = std::max<std::int64_t>(0, (t_us * kNsPerMicro + period_ns - 1) / period_ns);
    ended_ = false;
    return {};
  }
  [[nodiscard]] std::int64_t duration_us() const final {
    return (moments_.count() - 1) * moments_.period_ns() / kNsPerMicro;
  }
  [[nodiscard]] std::uint64_t count() const override {
    return static_cast<std::uint64_t>(moments_.count()) * kMessagesOfAMoment;
  }

 protected:
  explicit MomentsOutput(FlightMoments moments) : moments_(std::move(moments)) {}
  virtual Status publish(const FlightMoment& moment, PlaybackSummary& summary) = 0;

  FlightMoments moments_;

 private:
  std::int64_t next_ = 0;
  bool ended_ = false;
};

class LcmOutput final : public MomentsOutput {
 public:
  LcmOutput(FlightMoments moments, std::string url)
      : MomentsOutput(std::move(moments)), url_(std::move(url)) {}

  Status open(const std::atomic<bool>* stop) override {
    auto publisher = lcm::FlightPublisher::open(url_, stop);
    if (!publisher) return publisher.error();
    publisher_ = std::move(*publisher);
    return {};
  }
  [[nodiscard]] std::string place() const override { return url_; }
  [[nodiscard]] bool is_heard() const override { return true; }
  Status finish() override { return {}; }

 private:
  Status publish(const FlightMoment& moment, PlaybackSummary& summary) override {
    const Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
    Status status =
        publisher_->publish_pose(moment.number, moment.t_ns, moment.T_map_body * T_body_camera);
    if (!status) return status;
    SensorSamples samples;
    samples.gps = {moment.gps};
    samples.imu = {moment.imu};
    status = publisher_->publish_samples(samples);
    if (status) summary.sent += kMessagesOfAMoment;
    return status;
  }

  std::string url_;
  std::unique_ptr<lcm::FlightPublisher> publisher_;
};

class RosOutput final : public MomentsOutput {
 public:
  RosOutput(FlightMoments moments, RosTarget target)
      : MomentsOutput(std::move(moments)), target_(std::move(target)) {}

  Status open(const std::atomic<bool>* stop) override {
    auto publisher = ros1::FlightPublisher::open(
        {target_.master_uri, target_.node_name, target_.patience}, stop);
    if (!publisher) return publisher.error();
    publisher_ = std::move(*publisher);
    return {};
  }
  [[nodiscard]] std::string place() const override {
    return "the topics of MAVROS at " + target_.master_uri;
  }
  void wait(TimePoint now, std::chrono::milliseconds patience) override {
    MomentsOutput::wait(now, patience);
    if (!publisher_->is_heard()) {
      heard_since_.reset();
    } else if (!heard_since_) {
      heard_since_ = now;
    }
    constexpr std::chrono::seconds kToConnect{1};
    is_heard_ = heard_since_ && now - *heard_since_ >= kToConnect;
  }
  [[nodiscard]] bool is_heard() const override { return is_heard_; }
  [[nodiscard]] std::uint64_t count() const override {
    return MomentsOutput::count() +
           static_cast<std::uint64_t>((moments_.count() + moments_a_second() - 1) /
                                      moments_a_second());
  }

  /// The vehicle is disarmed. ROS does not say when its queues are empty: they get a second.
  Status finish() override {
    if (last_stamp_ns_ == 0) return {};
    for (int i = 0; i < 10; ++i) {
      publisher_->publish_state(last_stamp_ns_, false);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return {};
  }

 private:
  [[nodiscard]] std::int64_t moments_a_second() const {
    return std::max<std::int64_t>(1, kNsPerS / moments_.period_ns());
  }
  Status publish(const FlightMoment& moment, PlaybackSummary& summary) override {
    last_stamp_ns_ = moments_.epoch_ns() + moment.t_ns;
    ros1::PublishedInstant instant;
    instant.stamp_ns = last_stamp_ns_;
    instant.position_map_m = moment.T_map_body.translation;
    instant.R_enu_body = moment.R_enu_body;
    instant.imu = moment.imu;
    instant.gps = moment.gps;
    const bool with_state = moment.number % moments_a_second() == 0;
    if (with_state) publisher_->publish_state(last_stamp_ns_, true);
    publisher_->publish(instant);
    (publisher_->is_heard() ? summary.sent : summary.unsent) +=
        kMessagesOfAMoment + (with_state ? 1 : 0);
    return {};
  }

  RosTarget target_;
  std::unique_ptr<ros1::FlightPublisher> publisher_;
  std::optional<TimePoint> heard_since_;
  bool is_heard_ = false;
  std::int64_t last_stamp_ns_ = 0;
};

}  // namespace

std::unique_ptr<PlaybackOutput> lcm_output(FlightMoments moments, const std::string& url) {
  return std::make_unique<LcmOutput>(std::move(moments), url);
}

std::unique_ptr<PlaybackOutput> ros_output(FlightMoments moments, RosTarget target) {
  return std::make_unique<RosOutput>(std::move(moments), std::move(target));
}

}  // namespace overfly::flight::playback
