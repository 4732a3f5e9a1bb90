// A conversation with one vehicle: requests, and the messages that answer them.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "flight/mavlink/autopilots.hpp"
#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/payload.hpp"

namespace overfly::flight::mavlink {

/// A message of the vehicle that a conversation holds.
struct HeldMessage {
  std::uint32_t id = 0;
  std::uint8_t component = 0;
  std::vector<std::uint8_t> payload;

  [[nodiscard]] bool is(MessageId wanted) const { return id == static_cast<std::uint32_t>(wanted); }
  [[nodiscard]] PayloadReader reader() const { return PayloadReader(payload); }
  /// A frame with this payload, for the decoders of messages.hpp.
  [[nodiscard]] Frame frame() const { return {Version::kTwo, 0, 0, component, id, false, payload}; }
};

/// The vehicle that a conversation is with.
struct Target {
  std::uint8_t system = 1;
  std::uint8_t component = 1;
  std::uint8_t autopilot = kArduPilot;  ///< MAV_AUTOPILOT
  [[nodiscard]] std::string name() const {
    return "vehicle " + std::to_string(system) + "." + std::to_string(component);
  }
};

/// Sends requests and receives what the vehicle says from then on. Operations are functions on it,
/// so that they can be tested without a network.
class Exchange {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  virtual ~Exchange() = default;
  [[nodiscard]] virtual Target target() const = 0;
  /// Errors: kConflict on a read-only link.
  [[nodiscard]] virtual Status send(MessageId id, const PayloadWriter& payload) = 0;
  /// The next message of the vehicle's components to this program or to all; empty at the deadline.
  /// Errors: kCancelled; kInternal if the session has failed.
  [[nodiscard]] virtual Result<std::optional<HeldMessage>> next(TimePoint deadline) = 0;
  [[nodiscard]] virtual TimePoint now() const = 0;
};

/// The most messages that a conversation holds.
inline constexpr std::size_t kMaxHeldMessages = 4096;

/// Whether a message is meant for a ground station: the answers of the command and mission
/// protocols name whom they answer. 0 stands for all, as do messages without such fields (MAVLink 1
/// leaves those of COMMAND_ACK out).
/// @param system, component  of the ground station
[[nodiscard]] bool is_addressed_to(const Frame& frame, std::uint8_t system, std::uint8_t component);

/// Whether the component that requests go to has sent a message. Requests to component 0 go to all.
[[nodiscard]] bool is_from_target(const Exchange& exchange, const HeldMessage& message);

/// Drops what has arrived so far, at most kMaxHeldMessages: it answers no later request.
/// Errors: as Exchange::next.
[[nodiscard]] Status drop_held(Exchange& exchange);

/// How long answers are waited for, and how often a request is repeated without one.
struct Patience {
  std::chrono::milliseconds answer{1000};
  int attempts = 5;
};

/// The error after the last attempt: "WHAT: vehicle 1.1 did not answer 5 requests within 1 s each".
[[nodiscard]] Error no_answer(const Exchange& exchange,
                              const std::string& what,
                              const Patience& patience);

/// The next message that `match` accepts; empty at the deadline, also while others keep coming.
/// Errors: as Exchange::next.
template <typename Match>
[[nodiscard]] Result<std::optional<HeldMessage>> wait_for(Exchange& exchange,
                                                          Exchange::TimePoint deadline,
                                                          const Match& match) {
  while (true) {
    Result<std::optional<HeldMessage>> message = exchange.next(deadline);
    if (!message || !*message || match(**message)) return message;
    if (exchange.now() >= deadline) return std::optional<HeldMessage>();
  }
}

/// Calls `request(attempt)`, attempt from 0, until a message matches.
/// Errors: as Exchange; no_answer().
template <typename Request, typename Match>
[[nodiscard]] Result<HeldMessage> ask(Exchange& exchange,
                                      const std::string& what,
                                      const Patience& patience,
                                      const Request& request,
                                      const Match& match) {
  for (int attempt = 0; attempt < patience.attempts; ++attempt) {
    if (Status status = request(attempt); !status) return status.error().in(what);
    Result<std::optional<HeldMessage>> message =
        wait_for(exchange, exchange.now() + patience.answer, match);
    if (!message) return message.error().in(what);
    if (*message) return std::move(**message);
  }
  return no_answer(exchange, what, patience);
}

}  // namespace overfly::flight::mavlink
