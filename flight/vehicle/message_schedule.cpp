#include "flight/vehicle/message_schedule.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace overfly::vehicle {
namespace {

using flight::mavlink::MessageId;

constexpr std::int64_t kShortestIntervalNs = 10'000'000;
constexpr double kLongestIntervalUs = 1e9;

struct Message {
  MessageId id;
  std::uint8_t stream;  ///< MAV_DATA_STREAM; 0: only in "all"
  double rate_hz;       ///< until others are asked for; 0: not sent
};

constexpr std::array kOwnMessages{
    Message{MessageId::kHeartbeat, 0, 1.0},
    Message{MessageId::kExtendedSysState, 0, 1.0},
    Message{MessageId::kSysStatus, 2, 1.0},
    Message{MessageId::kGpsRawInt, 2, 5.0},
    Message{MessageId::kMissionCurrent, 2, 1.0},
    Message{MessageId::kGlobalPositionInt, 6, 10.0},
    Message{MessageId::kLocalPositionNed, 6, 4.0},
    Message{MessageId::kAttitude, 10, 10.0},
    Message{MessageId::kSimState, 10, 10.0},
    Message{MessageId::kVfrHud, 11, 4.0},
    Message{MessageId::kRawImu, 1, 4.0},
    Message{MessageId::kScaledPressure, 1, 4.0},
    Message{MessageId::kAirspeed, 1, 4.0},
    Message{MessageId::kDistanceSensor, 12, 4.0},
    Message{MessageId::kAttitudeQuaternion, 0, 0.0},
    Message{MessageId::kHighresImu, 0, 0.0},
};

std::int64_t interval_ns_of(double rate_hz) {
  return rate_hz > 0.0 ? std::max(kShortestIntervalNs, static_cast<std::int64_t>(1e9 / rate_hz))
                       : 0;
}

}  // namespace

MessageSchedule::MessageSchedule() {
  for (const Message& message : kOwnMessages) {
    due_[message.id].interval_ns = interval_ns_of(message.rate_hz);
  }
}

bool MessageSchedule::set_interval(double message_id, double interval_us, std::int64_t now_ns) {
  if (!std::isfinite(interval_us)) return false;
  const auto* const message =
      std::find_if(kOwnMessages.begin(), kOwnMessages.end(), [&](const Message& each) {
        return static_cast<double>(each.id) == message_id;
      });
  if (message == kOwnMessages.end() || message->id == MessageId::kHeartbeat) return false;
  Due& due = due_[message->id];
  due.next_ns = now_ns;
  if (interval_us == 0.0) {
    due.interval_ns = interval_ns_of(message->rate_hz);
  } else {
    due.interval_ns =
        interval_us < 0.0 ? 0 : interval_ns_of(1e6 / std::min(interval_us, kLongestIntervalUs));
  }
  return true;
}

void MessageSchedule::set_stream(std::uint8_t stream, std::uint16_t rate_hz, std::int64_t now_ns) {
  for (const Message& message : kOwnMessages) {
    if (message.id == MessageId::kHeartbeat || (stream != 0 && message.stream != stream)) continue;
    due_[message.id] = {interval_ns_of(rate_hz), now_ns};
  }
}

void MessageSchedule::step(std::int64_t now_ns, const std::function<void(MessageId id)>& send) {
  for (auto& [id, due] : due_) {
    if (due.interval_ns == 0 || now_ns < due.next_ns) continue;
    // The next time counts from the last one, so that the rate holds where steps are coarse; a
    // vehicle that was late does not catch up in a burst.
    due.next_ns = std::max(due.next_ns + due.interval_ns, now_ns + due.interval_ns / 2);
    send(id);
  }
}

}  // namespace overfly::vehicle
