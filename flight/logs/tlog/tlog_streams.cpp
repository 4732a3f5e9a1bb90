#include "flight/logs/tlog/tlog_streams.hpp"

#include "flight/logs/ned_attitude.hpp"
#include "flight/mavlink/message_table.hpp"
#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/sensor_messages.hpp"

namespace overfly::flight::logs {
namespace {

using mavlink::MessageId;

struct SourceFacts {
  MessageId id;
  PositionKind position;
  bool attitude;
  SourceOrigin origin;
  int preference;
};

constexpr SourceFacts kMavlinkSources[] = {
    {MessageId::kSimState, PositionKind::kGeodetic, true, SourceOrigin::kSimulation, 0},
    {MessageId::kHilStateQuaternion, PositionKind::kGeodetic, true, SourceOrigin::kSimulation, 1},
    {MessageId::kSimstate, PositionKind::kNone, true, SourceOrigin::kSimulation, 2},
    {MessageId::kGlobalPositionInt, PositionKind::kGeodetic, false, SourceOrigin::kEstimate, 0},
    {MessageId::kLocalPositionNed, PositionKind::kLocal, false, SourceOrigin::kEstimate, 1},
    {MessageId::kAttitudeQuaternion, PositionKind::kNone, true, SourceOrigin::kEstimate, 0},
    {MessageId::kAttitude, PositionKind::kNone, true, SourceOrigin::kEstimate, 1},
    {MessageId::kAhrs2, PositionKind::kGeodetic, true, SourceOrigin::kEstimate, 2},
    {MessageId::kGpsRawInt, PositionKind::kGeodetic, false, SourceOrigin::kGps, 0},
};

bool is_imu(MessageId id) {
  return id == MessageId::kRawImu || id == MessageId::kScaledImu || id == MessageId::kScaledImu2 ||
         id == MessageId::kScaledImu3 || id == MessageId::kHighresImu;
}

Eigen::Vector3d vector_of(const mavlink::GlobalPosition& position) {
  return {position.lat_deg, position.lon_deg, position.alt_msl_m};
}

}  // namespace

std::string sender_name(const mavlink::Frame& frame) {
  return std::to_string(frame.system) + "." + std::to_string(frame.component);
}

StreamDescription describe_stream(const mavlink::Frame& frame) {
  const mavlink::MessageFacts* const facts = mavlink::message_facts(frame.message_id);
  StreamDescription description;
  description.vehicle = sender_name(frame);
  description.name = description.vehicle + "/" +
                     (facts != nullptr ? facts->name : "id " + std::to_string(frame.message_id));
  const auto id = static_cast<MessageId>(frame.message_id);
  description.imu = is_imu(id);
  description.sensors = mavlink::may_have_samples(id);
  for (const SourceFacts& source : kMavlinkSources) {
    if (source.id != id) continue;
    description.position = source.position;
    description.attitude = source.attitude;
    description.origin = source.origin;
    description.preference = source.preference;
  }
  return description;
}

void pass_samples(const mavlink::Frame& frame, StreamId id, const LogTime& time, LogSink& sink) {
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::kSimState:
    case MessageId::kHilStateQuaternion: {
      const mavlink::SimulatedState state =
          static_cast<MessageId>(frame.message_id) == MessageId::kSimState
              ? mavlink::decode_sim_state(frame)
              : mavlink::decode_hil_state_quaternion(frame);
      sink.position(id, time, vector_of(state.position));
      sink.attitude(id, time, state.R_ned_body);
      return;
    }
    case MessageId::kSimstate:
      return sink.attitude(id, time, R_ned_body_from(mavlink::decode_simstate(frame).angles));
    case MessageId::kGlobalPositionInt:
      return sink.position(id, time, vector_of(mavlink::decode_global_position(frame).position));
    case MessageId::kLocalPositionNed:
      return sink.position(id, time, mavlink::decode_local_position(frame).position_ned_m);
    case MessageId::kAttitudeQuaternion:
      return sink.attitude(id, time, mavlink::decode_attitude_quaternion(frame).R_ned_body);
    case MessageId::kAttitude:
      return sink.attitude(id, time, R_ned_body_from(mavlink::decode_attitude(frame).angles));
    case MessageId::kAhrs2: {
      const mavlink::Ahrs2 state = mavlink::decode_ahrs2(frame);
      sink.position(id, time, vector_of(state.position));
      return sink.attitude(id, time, R_ned_body_from(state.angles));
    }
    case MessageId::kGpsRawInt: {
      const mavlink::GpsRaw gps = mavlink::decode_gps_raw(frame);
      if (gps.fix_type < 3) return sink.no_sample(id);
      return sink.position(id, time, vector_of(gps.position));
    }
    default:
      return;
  }
}

}  // namespace overfly::flight::logs
