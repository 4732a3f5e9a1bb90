#include "flight/live/live_samples.hpp"

#include <algorithm>
#include <cmath>

#include "flight/logs/stream_statistics.hpp"
#include "flight/mavlink/messages.hpp"

namespace overfly::flight::live {
namespace {

using mavlink::MessageId;

MessageId id_of(const mavlink::Frame& frame) { return static_cast<MessageId>(frame.message_id); }

std::optional<Eigen::Vector3d> velocity_of(const mavlink::Frame& frame) {
  switch (id_of(frame)) {
    case MessageId::kSimState:
      return mavlink::decode_sim_state(frame).velocity_ned_m_s;
    case MessageId::kHilStateQuaternion:
      return mavlink::decode_hil_state_quaternion(frame).velocity_ned_m_s;
    case MessageId::kGlobalPositionInt:
      return mavlink::decode_global_position(frame).velocity_ned_m_s;
    case MessageId::kLocalPositionNed:
      return mavlink::decode_local_position(frame).velocity_ned_m_s;
    default:
      return std::nullopt;
  }
}

std::optional<Eigen::Vector3d> rate_of(const mavlink::Frame& frame) {
  switch (id_of(frame)) {
    case MessageId::kSimState:
      return mavlink::decode_sim_state(frame).rate_rad_s;
    case MessageId::kHilStateQuaternion:
      return mavlink::decode_hil_state_quaternion(frame).rate_rad_s;
    case MessageId::kAttitude:
      return mavlink::decode_attitude(frame).rate_rad_s;
    case MessageId::kAttitudeQuaternion:
      return mavlink::decode_attitude_quaternion(frame).rate_rad_s;
    default:
      return std::nullopt;
  }
}

/// Velocities of sensors gone wrong would throw an interpolated aircraft across the country.
bool is_within(const std::optional<Eigen::Vector3d>& value, double limit) {
  return value && value->allFinite() && value->norm() <= limit;
}

template <typename Sample>
void forget(std::deque<Sample>& samples, std::int64_t t_ns) {
  while (samples.size() > 1 && samples[1].t_ns <= t_ns) samples.pop_front();
}

}  // namespace

/// Puts a sample at its place. Nothing happens if its time is known.
template <typename Sample>
void LiveSamples::insert_by_time(std::deque<Sample>& samples, const Sample& sample) {
  if (samples.empty() || samples.back().t_ns < sample.t_ns) {
    samples.push_back(sample);
    return;
  }
  const auto at = std::lower_bound(
      samples.begin(), samples.end(), sample.t_ns, [](const Sample& each, std::int64_t t_ns) {
        return each.t_ns < t_ns;
      });
  const bool is_known = at->t_ns == sample.t_ns;
  const std::int64_t back_ns = samples.back().t_ns - sample.t_ns;
  if (back_ns > 0 && position_ && (is_known || sample.t_ns < forgotten_ns_)) {
    ++doubts_.backward;
    if (back_ns > doubts_.furthest_back_ns) {
      doubts_.furthest_back_ns = back_ns;
      doubts_.furthest_back_at_ns = samples.back().t_ns;
    }
  }
  if (!is_known) samples.insert(at, sample);
}

void LiveSamples::count_jump(const LivePosition& from, const LivePosition& to) {
  const double jump_m = logs::jump_between_m(
      logs::PositionKind::kGeodetic, from.geodetic, to.geodetic, to.t_ns - from.t_ns);
  if (jump_m == 0.0) return;
  ++doubts_.jumps;
  if (jump_m <= doubts_.largest_jump_m) return;
  doubts_.largest_jump_m = jump_m;
  doubts_.largest_jump_ns = to.t_ns;
}

void LiveSamples::take(const mavlink::Frame& frame) {
  if (restarted_) return;
  streams_of_frames_.take(frame);
}

void LiveSamples::event(logs::LogEvent event) {
  std::optional<FlightEvent> kept = logs::flight_event_of(event.kind, event.text);
  if (!kept) return;
  // Before the first time of the vehicle's clock: in force from the start.
  kept->t_ns = event.time ? event.time->t_ns : 0;
  events_.push_back(std::move(*kept));
  if (events_.size() <= kMaxLiveEvents) return;
  ++lost_events_;
  const auto other = std::find_if(events_.begin(), events_.end(), [](const FlightEvent& each) {
    return each.kind == FlightEventKind::kOther;
  });
  events_.erase(other != events_.end() ? other : events_.begin());
}

bool LiveSamples::stream(logs::StreamId id, const logs::StreamDescription& description) {
  streams_.push_back({description, {}, {}, std::nullopt, 0});
  const bool sample = description.position != logs::PositionKind::kNone || description.attitude;
  return sample && (!position_ || id == *position_ || id == *attitude_);
}

void LiveSamples::message(logs::StreamId /*id*/, const std::optional<logs::LogTime>& time) {
  const mavlink::Frame& frame = streams_of_frames_.passing();
  if (id_of(frame) == MessageId::kVfrHud) {
    const double airspeed_m_s = mavlink::decode_vfr_hud(frame).airspeed_m_s;
    if (airspeed_m_s >= 0.0 && airspeed_m_s <= 1000.0) indicated_airspeed_m_s_ = airspeed_m_s;
  }
  if (!time) return;
  if (!boot_) boot_ = time->boot;
  if (time->boot != *boot_) {
    restarted_ = true;
    return;
  }
  if (!first_ns_) first_ns_ = time->t_ns;
  latest_ns_ = std::max(latest_ns_.value_or(time->t_ns), time->t_ns);
  sensors_.take(frame, *latest_ns_);
}

void LiveSamples::local_origin(logs::StreamId id, const logs::LocalOrigin& origin) {
  if (id < streams_.size()) streams_[id].origin = origin;
}

logs::PositionKind LiveSamples::position_kind(logs::StreamId id) const {
  return id < streams_.size() ? streams_[id].description.position : logs::PositionKind::kNone;
}

void LiveSamples::take_position(logs::StreamId id,
                                const logs::LogTime& time,
                                const Eigen::Vector3d& value) {
  if (restarted_ || (position_ && id != *position_)) return;
  LiveStream& stream = streams_[id];
  LivePosition sample{time.t_ns, value, Eigen::Vector3d::Zero(), false, indicated_airspeed_m_s_};
  if (stream.description.position == logs::PositionKind::kLocal) {
    if (!stream.origin) {
      ++stream.without_origin;
      return;
    }
    sample.geodetic = logs::geodetic_from_local(*stream.origin, value);
  }
  const std::optional<Eigen::Vector3d> velocity = velocity_of(streams_of_frames_.passing());
  constexpr double kMaxSpeedMS = 1000.0;
  if (is_within(velocity, kMaxSpeedMS)) {
    sample.v_ned_m_s = *velocity;
    sample.has_velocity = true;
  }
  full_ = full_ || stream.positions.size() >= kMaxLiveSamples;
  if (full_) return;
  if (position_ && !stream.positions.empty() && stream.positions.back().t_ns != sample.t_ns) {
    count_jump(stream.positions.back(), sample);
  }
  insert_by_time(stream.positions, sample);
}

void LiveSamples::take_attitude(logs::StreamId id,
                                const logs::LogTime& time,
                                const Eigen::Quaterniond& R_ned_body) {
  if (restarted_ || (attitude_ && id != *attitude_)) return;
  LiveAttitude sample{time.t_ns, R_ned_body.normalized(), Eigen::Vector3d::Zero(), false};
  const std::optional<Eigen::Vector3d> rate = rate_of(streams_of_frames_.passing());
  constexpr double kMaxRateRadS = 100.0;
  if (is_within(rate, kMaxRateRadS)) {
    sample.rate_rad_s = *rate;
    sample.has_rate = true;
  }
  std::deque<LiveAttitude>& attitudes = streams_[id].attitudes;
  full_ = full_ || attitudes.size() >= kMaxLiveSamples;
  if (!full_) insert_by_time(attitudes, sample);
}

void LiveSamples::keep_only(logs::StreamId position, logs::StreamId attitude) {
  position_ = position;
  attitude_ = attitude;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    if (i != position) streams_[i].positions.clear();
    if (i != attitude) streams_[i].attitudes.clear();
  }
}

void LiveSamples::start_at(std::int64_t t_ns) {
  forget_before(t_ns);
  doubts_ = {};
  if (!position_) return;
  const std::deque<LivePosition>& positions = streams_[*position_].positions;
  for (std::size_t i = 1; i < positions.size(); ++i) count_jump(positions[i - 1], positions[i]);
}

void LiveSamples::forget_before(std::int64_t t_ns) {
  if (!position_) return;
  forgotten_ns_ = t_ns;
  forget(streams_[*position_].positions, t_ns);
  forget(streams_[*attitude_].attitudes, t_ns);
}

}  // namespace overfly::flight::live
