#include "flight/mavlink/vehicle/exchange.hpp"

#include "core/text/number_text.hpp"

namespace overfly::flight::mavlink {
namespace {

/// Offset of target_system, which target_component follows; empty for messages to all.
std::optional<std::size_t> addressee_at(std::uint32_t message_id) {
  switch (static_cast<MessageId>(message_id)) {
    case MessageId::kMissionAck:
      return 0;
    case MessageId::kMissionRequest:
    case MessageId::kMissionRequestInt:
    case MessageId::kMissionCount:
      return 2;
    case MessageId::kCommandAck:
      return 8;
    case MessageId::kMissionItem:
    case MessageId::kMissionItemInt:
      return 32;
    default:
      return std::nullopt;
  }
}

}  // namespace

bool is_addressed_to(const Frame& frame, std::uint8_t system, std::uint8_t component) {
  const std::optional<std::size_t> at = addressee_at(frame.message_id);
  if (!at) return true;
  const PayloadReader payload(frame.payload);
  const auto is_one_of_all = [&](std::size_t offset, std::uint8_t number) {
    const auto addressed = payload.at<std::uint8_t>(offset);
    return addressed == 0 || addressed == number;
  };
  return is_one_of_all(*at, system) && is_one_of_all(*at + 1, component);
}

bool is_from_target(const Exchange& exchange, const HeldMessage& message) {
  const std::uint8_t component = exchange.target().component;
  return component == 0 || message.component == component;
}

Status drop_held(Exchange& exchange) {
  for (std::size_t i = 0; i < kMaxHeldMessages; ++i) {
    const Result<std::optional<HeldMessage>> message = exchange.next(exchange.now());
    if (!message) return message.error();
    if (!*message) break;
  }
  return {};
}

Error no_answer(const Exchange& exchange, const std::string& what, const Patience& patience) {
  const double seconds = static_cast<double>(patience.answer.count()) * 1e-3;
  return {ErrorCode::kIo,
          what + ": " + exchange.target().name() + " did not answer " +
              std::to_string(patience.attempts) + " requests within " + number_text(seconds) +
              " s each"};
}

}  // namespace overfly::flight::mavlink
