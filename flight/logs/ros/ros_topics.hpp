// The topics of a recording of ROS messages as streams of a flight log.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "flight/logs/boot_clock.hpp"
#include "flight/logs/held_messages.hpp"
#include "flight/logs/log_sink.hpp"
#include "flight/logs/ros/camera_poses.hpp"
#include "flight/logs/ros/frame_tree.hpp"
#include "flight/logs/ros/message_sink.hpp"
#include "flight/logs/ros/ros_messages.hpp"

namespace overfly::flight::logs {

/// Passes the messages of topics to a sink.
///
/// A stream is a topic. Messages of the types in RosType have the time of their header; all others
/// are listed with the time at which they were recorded. Each topic has a BootClock of its own,
/// because the clocks of sensors may differ. Poses of cameras become those of the body, by the
/// transforms of the recording (CameraPoses). Of several topics with samples of one sensor, those
/// with "raw" in their names come first, then those that were met first.
class RosTopics final : public RosMessageSink {
 public:
  explicit RosTopics(LogSink& sink) : sink_(sink) {}

  [[nodiscard]] std::optional<Topic> add(const std::string& name,
                                         std::string_view type,
                                         RosEncoding encoding) override;
  void take(Topic topic,
            std::span<const std::uint8_t> data,
            std::uint64_t recorded_ns,
            const MessagePlace& place) override;
  /// Reports what was left out.
  void report() override;

 private:
  struct Stream {
    RosType type = RosType::kOther;
    RosEncoding encoding = RosEncoding::kOther;
    std::string topic;
    RosTopicName name;
    bool transforms = false;
    std::string camera_frame;  ///< as camera_frame_of()
    bool sensors = false;
    bool wanted = false;
    BootClock clock;
    HeldMessages<std::optional<RosSample>> held;
    CameraPoses camera_poses;
  };
  using Key = std::pair<std::string, std::pair<std::string, RosEncoding>>;

  void take_frames(const Stream& stream, std::span<const std::uint8_t> data);
  void take(Topic topic, const std::optional<LogTime>& time, std::optional<RosSample> sample);
  void pass(Topic topic,
            const std::optional<LogTime>& time,
            const std::optional<RosSample>& sample);
  void deliver(Topic topic, const std::optional<LogTime>& time, std::optional<RosSample> sample);
  void pass_held(Topic topic);
  void deliver_held(Topic topic);
  std::optional<RosSample> decode(const Stream& stream,
                                  std::span<const std::uint8_t> data,
                                  std::uint64_t recorded_ns);

  LogSink& sink_;
  std::vector<Stream> streams_;  ///< by StreamId
  std::map<Key, Topic> topics_;
  FrameTree frames_;
  std::uint64_t left_out_topics_ = 0;
  std::uint64_t short_messages_ = 0;
  std::map<unsigned, std::uint64_t> refused_;  ///< messages, by CDR representation
};

}  // namespace overfly::flight::logs
