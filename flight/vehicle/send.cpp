#include "flight/vehicle/send.hpp"

namespace overfly::vehicle {

using flight::mavlink::MessageId;
using flight::mavlink::PayloadWriter;

void send_text(const std::string& text, Severity severity, std::uint16_t number, const Send& send) {
  constexpr std::size_t kPartBytes = 50;
  constexpr std::size_t kMostParts = 8;
  // A part that is full announces another one, which may be empty.
  const bool single = text.size() < kPartBytes;
  for (std::size_t part = 0; part < kMostParts && part * kPartBytes <= text.size(); ++part) {
    PayloadWriter payload(54);
    payload.put(0, static_cast<std::uint8_t>(severity))
        .put_text(1, text.substr(part * kPartBytes), kPartBytes);
    if (!single) payload.put(51, number).put(53, static_cast<std::uint8_t>(part));
    send(MessageId::kStatusText, payload, 0);
  }
}

}  // namespace overfly::vehicle
