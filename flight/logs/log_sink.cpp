#include "flight/logs/log_sink.hpp"

#include <cmath>

namespace overfly::flight::logs {
namespace {

/// Local positions beyond this are not those of a small aircraft.
constexpr double kFarthestM = 1e7;

bool is_plausible(PositionKind kind, const Eigen::Vector3d& value) {
  if (!value.allFinite()) return false;
  if (kind == PositionKind::kLocal) return value.cwiseAbs().maxCoeff() <= kFarthestM;
  const bool fix = value.x() != 0.0 || value.y() != 0.0;
  return fix && std::abs(value.x()) <= 90.0 && std::abs(value.y()) <= 180.0 &&
         value.z() >= -1000.0 && value.z() <= 100000.0;
}

}  // namespace

const char* to_string(SourceOrigin origin) {
  switch (origin) {
    case SourceOrigin::kSimulation:
      return "simulation";
    case SourceOrigin::kEstimate:
      return "estimate";
    case SourceOrigin::kGps:
      return "gps";
    case SourceOrigin::kNone:
      break;
  }
  return "none";
}

const char* to_string(EventKind kind) {
  switch (kind) {
    case EventKind::kMode:
      return "mode";
    case EventKind::kArming:
      return "arming";
    case EventKind::kMission:
      return "mission";
    case EventKind::kCamera:
      return "camera";
    case EventKind::kText:
      return "text";
    case EventKind::kOther:
      break;
  }
  return "other";
}

std::optional<FlightEvent> flight_event_of(EventKind kind, const std::string& text) {
  FlightEvent event{0, FlightEventKind::kOther, text};
  switch (kind) {
    case EventKind::kMode: {
      event.kind = FlightEventKind::kMode;
      // "mode 10 (AUTO)"
      const std::size_t open = text.find('(');
      if (open != std::string::npos && text.ends_with(')')) {
        event.text = text.substr(open + 1, text.size() - open - 2);
      }
      return event;
    }
    case EventKind::kMission:
      if (text.starts_with("reached ")) return event;
      event.kind = FlightEventKind::kMissionItem;
      if (text.starts_with("to ")) event.text = text.substr(3);
      return event;
    case EventKind::kCamera:
      return std::nullopt;
    case EventKind::kArming:
    case EventKind::kText:
    case EventKind::kOther:
      break;
  }
  return event;
}

void LogSink::position(StreamId id, const LogTime& time, const Eigen::Vector3d& value) {
  if (is_plausible(position_kind(id), value)) {
    take_position(id, time, value);
  } else {
    wrong_value(id, time, {.position = value});
  }
}

void LogSink::attitude(StreamId id, const LogTime& time, const Eigen::Quaterniond& R_ned_body) {
  const double norm = R_ned_body.norm();
  if (norm >= 0.9 && norm <= 1.1) {
    take_attitude(id, time, R_ned_body.normalized());
  } else {
    wrong_value(id, time, {.quaternion_norm = norm});
  }
}

}  // namespace overfly::flight::logs
