#include "flight/mavlink/vehicle/vehicle_state.hpp"

#include <cmath>

#include "core/time.hpp"
#include "flight/logs/mode_names.hpp"
#include "flight/mavlink/payload.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr std::int64_t kClockBackNs = 2 * kNsPerS;

void take_heartbeat(const Frame& frame, VehicleState& state) {
  state.heartbeat = decode_heartbeat(frame);
  state.mode = logs::mode_text(state.heartbeat->custom_mode, state.heartbeat->is_ardu_plane());
}

void take_battery(const Frame& frame, VehicleState& state) {
  const PayloadReader payload(frame.payload);
  const auto millivolts = payload.at<std::uint16_t>(14);
  const auto percent = payload.at<std::int8_t>(30);
  // 65535 and -1 stand for unknown.
  state.battery_v.reset();
  state.battery_percent.reset();
  if (millivolts != 0xFFFF) state.battery_v = millivolts * 1e-3;
  if (percent >= 0) state.battery_percent = percent;
}

void take_local_origin(const Frame& frame, VehicleState& state) {
  const GlobalPosition origin = decode_gps_global_origin(frame);
  const bool in_range = std::abs(origin.lat_deg) <= 90.0 && std::abs(origin.lon_deg) <= 180.0;
  const bool unset = origin.lat_deg == 0.0 && origin.lon_deg == 0.0;
  if (in_range && !unset) state.origin = origin;
}

void take_system_time(const Frame& frame, VehicleState& state) {
  constexpr std::int64_t kYear2000Us = 946'684'800'000'000;
  constexpr std::int64_t kYear2100Us = 4'102'444'800'000'000;
  const SystemTime time = decode_system_time(frame);
  // 0, or the years since 1970, without a receiver that knows the date.
  if (time.unix_us < kYear2000Us || time.unix_us > kYear2100Us) return;
  state.utc_minus_boot_ns = time.unix_us * 1000 - time.boot_ns;
}

}  // namespace

void take_message(const Frame& frame, VehicleState& state) {
  ++state.messages;
  if (const std::optional<std::int64_t> boot_ns = boot_time_ns(frame)) {
    if (state.boot_ns && *boot_ns < *state.boot_ns - kClockBackNs) ++state.restarts;
    state.boot_ns = boot_ns;
  }
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::kHeartbeat:
      return take_heartbeat(frame, state);
    case MessageId::kSysStatus:
      return take_battery(frame, state);
    case MessageId::kGpsRawInt:
      state.gps = decode_gps_raw(frame);
      return;
    case MessageId::kGlobalPositionInt: {
      const GlobalPositionVelocity sample = decode_global_position(frame);
      state.position = sample.position;
      state.v_down_m_s = sample.velocity_ned_m_s.z();
      return;
    }
    case MessageId::kGpsGlobalOrigin:
      return take_local_origin(frame, state);
    case MessageId::kSystemTime:
      return take_system_time(frame, state);
    default:
      return;
  }
}

}  // namespace overfly::flight::mavlink
