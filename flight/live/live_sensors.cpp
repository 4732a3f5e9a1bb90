#include "flight/live/live_sensors.hpp"

#include <optional>

#include "flight/mavlink/message_table.hpp"
#include "flight/mavlink/messages.hpp"

namespace overfly::flight::live {

void LiveSensors::take(const mavlink::Frame& frame, std::int64_t latest_ns) {
  if (static_cast<mavlink::MessageId>(frame.message_id) == mavlink::MessageId::kHeartbeat) {
    autopilot_ = mavlink::decode_heartbeat(frame).autopilot;
    return;
  }
  const std::optional<mavlink::MessageSamples> measured =
      mavlink::sensor_samples_of(frame, {latest_ns, autopilot_, geoid_separation_m_});
  if (!measured) return;
  const mavlink::MessageFacts* const facts = mavlink::message_facts(frame.message_id);
  tracks_.add(measured->preference, facts != nullptr ? facts->name : "", measured->samples);
}

std::string LiveSensors::report() const {
  const std::string sensors = tracks_.report("not sent");
  return sensors.empty() ? sensors : "sensors of the vehicle: " + sensors;
}

}  // namespace overfly::flight::live
