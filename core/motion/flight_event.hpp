// What happens during a flight in addition to its motion: events, and the state that a live
// vehicle reports.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace overfly {

enum class FlightEventKind {
  kMode,         ///< a flight mode or phase begins; it lasts until the next one
  kMissionItem,  ///< an item of the mission begins; it lasts until the next one
  kOther,        ///< an instant: armed, a text of the vehicle, ...
};
/// "mode", "mission", "event"
[[nodiscard]] inline const char* to_string(FlightEventKind kind) {
  switch (kind) {
    case FlightEventKind::kMode:
      return "mode";
    case FlightEventKind::kMissionItem:
      return "mission";
    case FlightEventKind::kOther:
      break;
  }
  return "event";
}

struct FlightEvent {
  std::int64_t t_ns = 0;  ///< from the start of the flight
  FlightEventKind kind = FlightEventKind::kOther;
  std::string text;  ///< of modes and items: only the name
};

/// A live vehicle at one instant. Empty: the vehicle has not sent it.
struct VehicleStatus {
  std::int64_t t_ns = 0;  ///< from the start of the flight
  std::string vehicle;    ///< system and component: "1.1"
  std::string mode;       ///< empty: not known
  std::optional<bool> armed;
  std::optional<double> battery_v;
  std::optional<int> battery_percent;
  std::optional<int> gps_fix;  ///< GPS_FIX_TYPE of MAVLink: 3 and above in three dimensions
  std::optional<int> satellites;
  double messages_per_s = 0.0;      ///< per second of the vehicle's clock
  std::uint64_t lost_messages = 0;  ///< by sequence numbers, since the link was opened
  double lost_percent = 0.0;
  std::optional<double> clock_rate;     ///< vehicle seconds per second of this machine
  std::optional<double> round_trip_ms;  ///< of a request for the vehicle's time
  std::uint64_t gaps = 0;               ///< between samples of the truth so far
};

}  // namespace overfly
