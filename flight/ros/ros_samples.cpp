#include "flight/ros/ros_samples.hpp"

#include <algorithm>

#include "core/motion/pose.hpp"
#include "core/text/printable_text.hpp"

namespace overfly::flight::ros_live {
namespace {

using logs::PositionKind;

/// Puts a sample at its place. Nothing happens if its time is known.
template <typename Sample>
void insert_sample(std::deque<Sample>& samples, const Sample& sample) {
  const auto at = std::lower_bound(
      samples.begin(), samples.end(), sample.t_ns, [](const Sample& each, std::int64_t t_ns) {
        return each.t_ns < t_ns;
      });
  if (at == samples.end() || at->t_ns != sample.t_ns) samples.insert(at, sample);
}

/// Leaves one sample before the time: velocities are differences.
template <typename Sample>
void forget_samples(std::deque<Sample>& samples, std::int64_t t_ns) {
  while (samples.size() > 1 && samples[1].t_ns < t_ns) samples.pop_front();
}

}  // namespace

void RosSamples::take(const std::string& topic,
                      std::string_view type,
                      std::span<const std::uint8_t> bytes) {
  if (!restarted_.empty()) return;
  // Publishers may declare any number of types, and topics_ keeps each.
  if (logs::ros_type_named(type) == logs::RosType::kOther) {
    if (!is_of_flight(topic)) return;
    constexpr std::size_t kShown = 100;
    type = type.substr(0, kShown);
    other_type_ =
        printable_text({reinterpret_cast<const std::uint8_t*>(type.data()), type.size()}) + " on " +
        topic;
    return;
  }
  const auto known = topics_.add(topic, type, logs::RosEncoding::kRos1);
  if (known) topics_.take(*known, bytes, 0, {});
}

bool RosSamples::stream(logs::StreamId /*id*/, const logs::StreamDescription& description) {
  streams_.push_back({description.name, description.position, std::nullopt});
  return description.position != PositionKind::kNone || description.attitude || description.sensors;
}

void RosSamples::message(logs::StreamId id, const std::optional<logs::LogTime>& time) {
  if (!time) return;
  Stream& stream = streams_[id];
  if (!stream.boot) stream.boot = time->boot;
  if (*stream.boot != time->boot && is_of_flight(stream.topic)) restarted_ = stream.topic;
}

void RosSamples::samples(logs::StreamId id,
                         const logs::LogTime& time,
                         int preference,
                         const SensorSamples& samples) {
  if (restarted_.empty() && streams_[id].boot == time.boot) {
    sensors_.add(preference, streams_[id].topic, samples);
  }
}

PositionKind RosSamples::position_kind(logs::StreamId id) const {
  return id < streams_.size() ? streams_[id].position : PositionKind::kNone;
}

void RosSamples::take_position(logs::StreamId id,
                               const logs::LogTime& time,
                               const Eigen::Vector3d& value) {
  if (!restarted_.empty() || streams_[id].topic != flight_.position_topic()) return;
  live::LivePosition sample{time.t_ns, value, Eigen::Vector3d::Zero(), false, -1.0};
  const bool is_local = streams_[id].position == PositionKind::kLocal;
  if (is_local != flight_.local) return;
  if (is_local) {
    const Geodetic point = local_.geodetic_from_world({value.y(), value.x(), -value.z()});
    sample.geodetic = {
        deg_from_rad(point.lat_rad), deg_from_rad(point.lon_rad), point.alt_ellipsoid_m};
  }
  full_ = full_ || positions_.size() >= live::kMaxLiveSamples;
  if (!full_) insert_sample(positions_, sample);
}

void RosSamples::take_attitude(logs::StreamId id,
                               const logs::LogTime& time,
                               const Eigen::Quaterniond& R_ned_body) {
  if (!restarted_.empty() || streams_[id].topic != flight_.attitude_topic()) return;
  full_ = full_ || attitudes_.size() >= live::kMaxLiveSamples;
  if (full_) return;
  insert_sample(attitudes_, {time.t_ns, R_ned_body.normalized(), Eigen::Vector3d::Zero(), false});
}

void RosSamples::forget_before(std::int64_t t_ns) {
  forget_samples(positions_, t_ns);
  forget_samples(attitudes_, t_ns);
}

std::string RosSamples::missing_text() const {
  std::string text;
  const auto add = [&text](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  if (positions_.empty()) {
    add(std::string("no valid ") + (flight_.local ? "PoseStamped or Odometry" : "NavSatFix") +
        " has come on " + flight_.position_topic());
  }
  if (attitudes_.empty()) {
    add(std::string("no valid ") + (flight_.attitude_of_pose ? "PoseStamped or Odometry" : "Imu") +
        " has come on " + flight_.attitude_topic());
  }
  if (invalid_ > 0) add(std::to_string(invalid_) + " samples were invalid");
  if (!other_type_.empty()) add("another type came: " + other_type_);
  return text.empty() ? "positions and attitudes have no time in common" : text;
}

}  // namespace overfly::flight::ros_live
