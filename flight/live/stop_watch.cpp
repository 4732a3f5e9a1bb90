#include "flight/live/stop_watch.hpp"

#include <utility>

#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/payload.hpp"

namespace overfly::flight::live {
namespace {

/// MAV_LANDED_STATE
constexpr std::uint8_t kOnGround = 1;
constexpr std::uint8_t kInAir = 2;

}  // namespace

std::string StopWatch::take(const mavlink::Frame& frame) {
  using mavlink::MessageId;
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::kHeartbeat: {
      const mavlink::Heartbeat heartbeat = mavlink::decode_heartbeat(frame);
      if (!heartbeat.is_autopilot()) return {};
      if (heartbeat.armed()) was_armed_ = true;
      if (conditions_.on_disarm && was_armed_ && !heartbeat.armed()) {
        return "the vehicle was disarmed";
      }
      return {};
    }
    case MessageId::kExtendedSysState: {
      const auto landed = mavlink::PayloadReader(frame.payload).at<std::uint8_t>(1);
      if (landed == kInAir) was_in_air_ = true;
      if (conditions_.on_landing && was_in_air_ && landed == kOnGround) {
        return "the vehicle has landed";
      }
      return {};
    }
    case MessageId::kMissionCurrent: {
      const std::uint16_t item = mavlink::decode_mission_sequence(frame);
      const std::optional<std::uint16_t> before = std::exchange(item_, item);
      if (conditions_.mission_item < 0 || !before || *before == item) return {};
      // Items without a place are passed between two messages.
      const bool passed = *before < conditions_.mission_item && item > conditions_.mission_item;
      if (passed || item == conditions_.mission_item) {
        return "the mission has come to item " + std::to_string(item);
      }
      return {};
    }
    default:
      return {};
  }
}

}  // namespace overfly::flight::live
