// Which messages a simulated vehicle sends by itself, and how often.
#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "flight/mavlink/messages.hpp"

namespace overfly::vehicle {

/// Rates of messages, at most 100 Hz each. HEARTBEAT is always sent.
class MessageSchedule {
 public:
  MessageSchedule();

  /// As SET_MESSAGE_INTERVAL: < 0 stops a message, 0 gives it its first rate.
  /// @return false for a message that the vehicle does not send by itself, and for not-a-number
  [[nodiscard]] bool set_interval(double message_id, double interval_us, std::int64_t now_ns);
  /// As REQUEST_DATA_STREAM: a rate of 0 stops the messages of a stream (MAV_DATA_STREAM; 0: all),
  /// grouped as ArduPlane does.
  void set_stream(std::uint8_t stream, std::uint16_t rate_hz, std::int64_t now_ns);

  /// Calls `send` for each message that is due.
  void step(std::int64_t now_ns, const std::function<void(flight::mavlink::MessageId id)>& send);

 private:
  struct Due {
    std::int64_t interval_ns = 0;  ///< 0: not sent
    std::int64_t next_ns = 0;
  };
  std::map<flight::mavlink::MessageId, Due> due_;
};

}  // namespace overfly::vehicle
