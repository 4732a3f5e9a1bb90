#include "flight/logs/ros/ros_topics.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include "core/text/printable_text.hpp"
#include "core/time.hpp"

namespace overfly::flight::logs {
namespace {

/// A recording has some hundred topics.
constexpr std::size_t kMaxRosTopics = 4096;
constexpr std::size_t kCdrHeaderBytes = 4;
constexpr unsigned kCdrBigEndian = 0;
constexpr unsigned kCdrLittleEndian = 1;

/// Names of the representation identifiers of DDS-XTypes 1.3, table 60, and DDSI-RTPS 2.5, 10.5.
const char* representation_name(unsigned representation) {
  switch (representation) {
    case 0x0002:
    case 0x0003:
      return " (PL_CDR)";
    case 0x0006:
    case 0x0007:
    case 0x0010:
    case 0x0011:
      return " (CDR2)";
    case 0x0008:
    case 0x0009:
    case 0x0014:
    case 0x0015:
      return " (D_CDR2)";
    case 0x000a:
    case 0x000b:
    case 0x0012:
    case 0x0013:
      return " (PL_CDR2)";
    default:
      return "";
  }
}

/// A receiver's answer was delivered when it was recorded, if both clocks are the same.
void set_delivery(std::uint64_t recorded_ns, SensorSamples& samples) {
  constexpr std::int64_t kMaxDelayNs = 10 * kNsPerS;
  for (GpsSample& gps : samples.gps) {
    const auto latest = static_cast<std::uint64_t>(gps.t_ns + kMaxDelayNs);
    if (gps.t_ns < 0 || recorded_ns > latest) continue;
    gps.delivered_ns = std::max(gps.t_ns, static_cast<std::int64_t>(recorded_ns));
  }
}

std::string topic_text(const std::string& name) {
  return printable_text({reinterpret_cast<const std::uint8_t*>(name.data()), name.size()});
}

}  // namespace

std::optional<RosTopics::Topic> RosTopics::add(const std::string& name,
                                               std::string_view type,
                                               RosEncoding encoding) {
  const auto [known, added] =
      topics_.try_emplace({name, {std::string(type), encoding}}, streams_.size());
  if (!added) return known->second;
  if (streams_.size() >= kMaxRosTopics) {
    topics_.erase(known);
    ++left_out_topics_;
    return std::nullopt;
  }
  Stream stream;
  stream.encoding = encoding;
  if (encoding != RosEncoding::kOther) stream.type = ros_type_named(type);
  stream.topic = topic_text(name);
  stream.name = ros_topic_name(name);
  stream.transforms = encoding != RosEncoding::kOther && is_transform_type(type);
  if (stream.type == RosType::kPoseStamped) stream.camera_frame = camera_frame_of(name);
  StreamDescription description = describe_topic(stream.topic, stream.type);
  stream.sensors = description.sensors;
  if (stream.type == RosType::kOther) description.vehicle = "recording";
  stream.wanted = sink_.stream(static_cast<StreamId>(streams_.size()), description);
  streams_.push_back(std::move(stream));
  return known->second;
}

std::optional<RosSample> RosTopics::decode(const Stream& stream,
                                           std::span<const std::uint8_t> data,
                                           std::uint64_t recorded_ns) {
  bool big_endian = false;
  if (stream.encoding == RosEncoding::kCdr) {
    if (data.size() < kCdrHeaderBytes) {
      ++short_messages_;
      return std::nullopt;
    }
    const unsigned representation = data[0] * 256U + data[1];
    if (representation != kCdrBigEndian && representation != kCdrLittleEndian) {
      ++refused_[representation];
      return std::nullopt;
    }
    big_endian = representation == kCdrBigEndian;
    data = data.subspan(kCdrHeaderBytes);
  }
  std::optional<RosSample> sample =
      decode_ros(stream.type, RosCursor(data, stream.encoding, big_endian), stream.name);
  if (!sample) {
    ++short_messages_;
    return sample;
  }
  if (!sample->camera_frame.empty()) frames_.see(sample->camera_frame);
  if (!stream.camera_frame.empty()) sample->camera_frame = stream.camera_frame;
  set_delivery(recorded_ns, sample->sensors);
  return sample;
}

/// The frames that an image or a message of transforms names.
void RosTopics::take_frames(const Stream& stream, std::span<const std::uint8_t> data) {
  std::optional<RosCursor> message = ros_cursor_of(data, stream.encoding);
  if (!message) return;
  const std::size_t known = frames_.size();
  if (stream.transforms) {
    frames_.take(*message);
  } else {
    const std::string_view frame = take_header(*message).frame_id;
    if (message->ok()) frames_.see(frame);
  }
  if (frames_.size() != known) sink_.declaration();
}

void RosTopics::take(Topic topic,
                     std::span<const std::uint8_t> data,
                     std::uint64_t recorded_ns,
                     const MessagePlace& /*place*/) {
  Stream& stream = streams_[topic];
  const bool is_image = stream.type == RosType::kImage || stream.type == RosType::kCompressedImage;
  if (is_image || stream.transforms) take_frames(stream, data);
  if (stream.type == RosType::kOther) {
    constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    const auto t_ns = recorded_ns <= kMost ? static_cast<std::int64_t>(recorded_ns) : -1;
    return take(topic, stream.clock.take(t_ns), std::nullopt);
  }
  std::optional<RosSample> sample = decode(stream, data, recorded_ns);
  const std::optional<LogTime> time =
      sample ? stream.clock.take(sample->stamp_ns) : std::optional<LogTime>();
  take(topic, time, std::move(sample));
}

void RosTopics::take(Topic topic,
                     const std::optional<LogTime>& time,
                     std::optional<RosSample> sample) {
  Stream& stream = streams_[topic];
  if (stream.held.must_hold(stream.clock)) {
    sink_.declaration();
    stream.held.hold(time, std::move(sample));
    return;
  }
  pass_held(topic);
  pass(topic, time, sample);
}

void RosTopics::pass_held(Topic topic) {
  Stream& stream = streams_[topic];
  stream.held.release(stream.clock, [&](const auto& time, const std::optional<RosSample>& sample) {
    pass(topic, time, sample);
  });
}

void RosTopics::pass(Topic topic,
                     const std::optional<LogTime>& time,
                     const std::optional<RosSample>& sample) {
  CameraPoses& poses = streams_[topic].camera_poses;
  if (poses.must_hold(sample, frames_)) {
    sink_.declaration();
    poses.hold(time, sample);
    return;
  }
  deliver_held(topic);
  deliver(topic, time, sample);
}

void RosTopics::deliver_held(Topic topic) {
  for (auto& [time, sample] : streams_[topic].camera_poses.take_held()) {
    deliver(topic, time, std::move(sample));
  }
}

void RosTopics::deliver(Topic topic,
                        const std::optional<LogTime>& time,
                        std::optional<RosSample> sample) {
  const auto id = static_cast<StreamId>(topic);
  sink_.message(id, time);
  Stream& stream = streams_[topic];
  if (sample) stream.camera_poses.convert(*sample, frames_);
  if (!stream.wanted || !time || !sample) return;
  if (stream.sensors) {
    const std::size_t preference = (stream.name.is_raw ? 0 : kMaxRosTopics) + topic;
    sink_.samples(id, *time, static_cast<int>(preference), sample->sensors);
  }
  if (sample->invalid) return sink_.no_sample(id);
  if (sample->position) sink_.position(id, *time, *sample->position);
  if (sample->R_ned_body) sink_.attitude(id, *time, *sample->R_ned_body);
}

void RosTopics::report() {
  for (Topic topic = 0; topic < streams_.size(); ++topic) {
    pass_held(topic);
    deliver_held(topic);
  }
  const auto warn = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) sink_.warning(std::to_string(count) + " " + text);
  };
  for (const auto& [representation, count] : refused_) {
    std::array<char, 8> hex{};
    std::snprintf(hex.data(), hex.size(), "0x%04x", representation);
    warn(count,
         "messages have the CDR representation " + std::string(hex.data()) +
             representation_name(representation) +
             ", which is not read: only plain CDR (0x0000, 0x0001) is");
  }
  warn(short_messages_, "messages are shorter than their type and were left out");
  warn(left_out_topics_,
       "declarations of topics were left out: only " + std::to_string(kMaxRosTopics) + " are read");
  for (const Stream& stream : streams_) {
    const std::string& camera = stream.camera_poses.assumed_camera();
    if (camera.empty()) continue;
    sink_.assumption(stream.topic + " has the poses of the camera " + camera +
                     ", and no transform between base_link and it states the camera's mount: it is "
                     "taken to look down, with the top of its image to the nose");
  }
  std::uint64_t implausible = 0;
  for (const Stream& stream : streams_) implausible += stream.clock.implausible();
  warn(implausible, "stamps of messages are implausible and were not used");
}

}  // namespace overfly::flight::logs
