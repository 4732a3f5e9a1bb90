#include "flight/mavlink/vehicle/commands.hpp"

#include <algorithm>

namespace overfly::flight::mavlink {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::uint8_t kAccepted = 0;
constexpr std::uint8_t kTemporarilyRejected = 1;
constexpr std::uint8_t kFailed = 4;
constexpr std::uint8_t kInProgress = 5;
constexpr seconds kProgressLimit{60};
constexpr std::size_t kMaxTexts = 4;

constexpr std::uint16_t kNavTakeOff = 22;
constexpr std::uint16_t kDoSetMode = 176;
constexpr std::uint16_t kMissionStart = 300;
constexpr std::uint16_t kArmDisarm = 400;
constexpr float kCustomModeEnabled = 1.0F;  // MAV_MODE_FLAG_CUSTOM_MODE_ENABLED

struct Answer {
  std::uint8_t result = 0;
  std::vector<std::string> texts;  ///< of STATUSTEXT meanwhile
};

PayloadWriter payload_of(const Exchange& exchange, const Command& command, int attempt) {
  PayloadWriter payload(33);
  for (std::size_t i = 0; i < command.parameters.size(); ++i) {
    payload.put(4 * i, command.parameters[i]);
  }
  return payload.put(28, command.id)
      .put(30, exchange.target().system)
      .put(31, exchange.target().component)
      .put(32, static_cast<std::uint8_t>(attempt));
}

void keep_text(const HeldMessage& message, std::vector<std::string>& texts) {
  if (!message.is(MessageId::kStatusText)) return;
  const std::string text = decode_status_text(message.frame()).text;
  if (texts.size() < kMaxTexts && std::find(texts.begin(), texts.end(), text) == texts.end()) {
    texts.push_back(text);
  }
}

/// COMMAND_ACK names the number of a command, not the request: one that comes late would answer the
/// next request with that number. The answers to all requests of this call are therefore waited
/// for, as long as all attempts may take.
Result<Answer> answer_to(Exchange& exchange, const Command& command, const Patience& patience) {
  Answer answer;
  int requests = 0;
  int answered = 0;
  const auto acknowledges = [&](const HeldMessage& message) {
    keep_text(message, answer.texts);
    if (!message.is(MessageId::kCommandAck) || !is_from_target(exchange, message) ||
        message.reader().at<std::uint16_t>(0) != command.id) {
      return false;
    }
    if (message.reader().at<std::uint8_t>(2) != kInProgress) ++answered;
    return true;
  };
  if (Status dropped = drop_held(exchange); !dropped) return dropped.error().in(command.what);
  Result<HeldMessage> first = ask(
      exchange,
      command.what,
      patience,
      [&](int attempt) {
        ++requests;
        return exchange.send(MessageId::kCommandLong, payload_of(exchange, command, attempt));
      },
      acknowledges);
  if (!first) {
    if (first.error().code != ErrorCode::kIo) return first.error();
    auto late = wait_for(exchange, exchange.now() + requests * patience.answer, acknowledges);
    if (!late) return late.error().in(command.what);
    if (!*late) return first.error();
    first = std::move(**late);
  }
  answer.result = first->reader().at<std::uint8_t>(2);
  const Exchange::TimePoint end = exchange.now() + kProgressLimit;
  while (answer.result == kInProgress) {
    const Result<std::optional<HeldMessage>> more = wait_for(exchange, end, acknowledges);
    if (!more) return more.error().in(command.what);
    if (!*more) {
      return Error{ErrorCode::kIo, command.what + ": is still in progress after 60 s"};
    }
    answer.result = (*more)->reader().at<std::uint8_t>(2);
  }
  // An autopilot sends the reason just after or before its refusal.
  if (answer.result != kAccepted) {
    const auto rest =
        wait_for(exchange, exchange.now() + milliseconds(100), [&](const HeldMessage& message) {
          keep_text(message, answer.texts);
          return false;
        });
    if (!rest) return rest.error().in(command.what);
  }
  const Exchange::TimePoint last = exchange.now() + requests * patience.answer;
  while (answered < requests) {
    const auto other = wait_for(exchange, last, acknowledges);
    if (!other) return other.error().in(command.what);
    if (!*other) break;
  }
  return answer;
}

Error refusal(const Exchange& exchange, const Command& command, const Answer& answer) {
  std::string reason;
  for (const std::string& text : answer.texts) reason += (reason.empty() ? ": " : "; ") + text;
  return {ErrorCode::kConflict,
          command.what + ": " + exchange.target().name() + " answers '" +
              result_text(answer.result) + "'" + reason};
}

/// Waits for a heartbeat of the vehicle that `match` accepts.
template <typename Match>
Status wait_for_heartbeat(Exchange& exchange, const std::string& what, const Match& match) {
  const auto found =
      wait_for(exchange, exchange.now() + seconds(5), [&](const HeldMessage& message) {
        return message.is(MessageId::kHeartbeat) &&
               message.component == exchange.target().component &&
               match(decode_heartbeat(message.frame()));
      });
  if (!found) return found.error().in(what);
  if (*found) return {};
  return Error{
      ErrorCode::kIo,
      what + ": " + exchange.target().name() + " accepted, but no heartbeat shows it within 5 s"};
}

}  // namespace

std::string result_text(std::uint8_t result) {
  static constexpr std::array kTexts = {"accepted",
                                        "temporarily rejected",
                                        "denied",
                                        "unsupported",
                                        "failed",
                                        "in progress",
                                        "cancelled"};
  return result < kTexts.size() ? kTexts[result] : "result " + std::to_string(result);
}

Result<std::uint8_t> command_result(Exchange& exchange,
                                    const Command& command,
                                    const Patience& patience) {
  const Result<Answer> answer = answer_to(exchange, command, patience);
  if (!answer) return answer.error();
  return answer->result;
}

Status run_command(Exchange& exchange, const Command& command) {
  const Result<Answer> answer = answer_to(exchange, command, {});
  if (!answer) return answer.error();
  if (answer->result != kAccepted) return refusal(exchange, command, *answer);
  return {};
}

Status arm(Exchange& exchange, std::chrono::seconds limit) {
  const Command command{"arming", kArmDisarm, {1.0F}};
  const Exchange::TimePoint end = exchange.now() + limit;
  while (true) {
    const Result<Answer> answer = answer_to(exchange, command, {});
    if (!answer) return answer.error();
    if (answer->result == kAccepted) break;
    const bool later = answer->result == kTemporarilyRejected || answer->result == kFailed;
    if (!later || exchange.now() >= end) return refusal(exchange, command, *answer);
    const auto pause = wait_for(
        exchange, exchange.now() + seconds(1), [](const HeldMessage& /*any*/) { return false; });
    if (!pause) return pause.error().in(command.what);
  }
  return wait_for_heartbeat(
      exchange, command.what, [](const Heartbeat& beat) { return beat.armed(); });
}

Status disarm(Exchange& exchange) { return run_command(exchange, {"disarming", kArmDisarm, {}}); }

Status change_mode(Exchange& exchange, std::uint32_t mode) {
  const Command command{"changing to mode " + std::to_string(mode),
                        kDoSetMode,
                        {kCustomModeEnabled, static_cast<float>(mode)}};
  if (Status status = run_command(exchange, command); !status) return status;
  return wait_for_heartbeat(
      exchange, command.what, [&](const Heartbeat& beat) { return beat.custom_mode == mode; });
}

Status start_mission(Exchange& exchange) {
  return run_command(exchange, {"starting the mission", kMissionStart, {}});
}

Status take_off(Exchange& exchange, double height_m) {
  return run_command(exchange,
                     {"taking off", kNavTakeOff, {0, 0, 0, 0, 0, 0, static_cast<float>(height_m)}});
}

}  // namespace overfly::flight::mavlink
