#include "flight/mavlink/vehicle/parameters.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "core/text/number_text.hpp"
#include "flight/mavlink/autopilots.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr std::uint8_t kFloat = 9;
constexpr std::int16_t kByName = -1;
/// Missing parameters that are asked for at once.
constexpr std::size_t kAskedAtOnce = 20;
constexpr int kRounds = 20;

struct Limits {
  double least = 0.0;
  double most = 0.0;
};

/// Of an integer type that a float of the message can hold bytewise; empty for others.
std::optional<Limits> integer_limits(std::uint8_t type) {
  switch (type) {
    case 1:
      return Limits{0.0, 255.0};
    case 2:
      return Limits{-128.0, 127.0};
    case 3:
      return Limits{0.0, 65535.0};
    case 4:
      return Limits{-32768.0, 32767.0};
    case 5:
      return Limits{0.0, 4294967295.0};
    case 6:
      return Limits{-2147483648.0, 2147483647.0};
    default:
      return std::nullopt;
  }
}

/// PX4 puts the bytes of integers into the float, ArduPilot their value (MAVLink developer guide,
/// "Parameter Encoding").
bool is_bytewise(const Exchange& exchange, std::uint8_t type) {
  return exchange.target().autopilot == kPx4 && integer_limits(type).has_value();
}

double value_from_wire(float wire, std::uint8_t type, bool bytewise) {
  if (!bytewise) return wire;
  const auto bits = std::bit_cast<std::uint32_t>(wire);
  switch (type) {
    case 1:
      return static_cast<std::uint8_t>(bits);
    case 2:
      return static_cast<std::int8_t>(bits);
    case 3:
      return static_cast<std::uint16_t>(bits);
    case 4:
      return static_cast<std::int16_t>(bits);
    case 6:
      return static_cast<std::int32_t>(bits);
    default:
      return bits;
  }
}

float wire_from_value(double value, bool bytewise) {
  if (!bytewise) return static_cast<float>(value);
  return std::bit_cast<float>(static_cast<std::uint32_t>(static_cast<std::int64_t>(value)));
}

Parameter decode_parameter(const Exchange& exchange, const HeldMessage& message) {
  const PayloadReader payload = message.reader();
  Parameter parameter;
  parameter.name = payload.text(8, kMaxParameterName);
  parameter.type = payload.at<std::uint8_t>(24);
  parameter.value =
      value_from_wire(payload.at<float>(0), parameter.type, is_bytewise(exchange, parameter.type));
  return parameter;
}

Status request_parameter(Exchange& exchange, const std::string& name, std::int16_t index) {
  return exchange.send(MessageId::kParamRequestRead,
                       PayloadWriter(20)
                           .put(0, index)
                           .put(2, exchange.target().system)
                           .put(3, exchange.target().component)
                           .put_text(4, name, kMaxParameterName));
}

bool is_value(const Exchange& exchange, const HeldMessage& message) {
  return message.is(MessageId::kParamValue) && is_from_target(exchange, message);
}

bool is_value_of(const Exchange& exchange, const HeldMessage& message, const std::string& name) {
  return is_value(exchange, message) && message.reader().text(8, kMaxParameterName) == name;
}

/// What has answered PARAM_REQUEST_LIST so far.
struct Collected {
  std::size_t count = 0;  ///< that the vehicle states
  std::map<std::uint16_t, Parameter> by_index;

  [[nodiscard]] bool complete() const { return count > 0 && by_index.size() >= count; }
  /// @pre is_value(exchange, message)
  void take(const Exchange& exchange, const HeldMessage& message) {
    const auto index = message.reader().at<std::uint16_t>(6);
    const auto stated = message.reader().at<std::uint16_t>(4);
    // ArduPilot sends 65535 as the index of an answer to a name.
    if (index >= stated) return;
    count = stated;
    by_index.insert_or_assign(index, decode_parameter(exchange, message));
  }
};

/// Takes parameters until they are complete or none came for a second.
Status collect(Exchange& exchange, Collected& collected) {
  while (!collected.complete()) {
    const auto message =
        wait_for(exchange, exchange.now() + std::chrono::seconds(1), [&](const HeldMessage& each) {
          return is_value(exchange, each);
        });
    if (!message) return message.error();
    if (!*message) return {};
    collected.take(exchange, **message);
  }
  return {};
}

Status request_missing(Exchange& exchange, const Collected& collected) {
  if (collected.count == 0) {
    return exchange.send(
        MessageId::kParamRequestList,
        PayloadWriter(2).put(0, exchange.target().system).put(1, exchange.target().component));
  }
  std::size_t asked = 0;
  for (std::size_t i = 0; i < collected.count && asked < kAskedAtOnce; ++i) {
    if (collected.by_index.contains(static_cast<std::uint16_t>(i))) continue;
    ++asked;
    if (Status status = request_parameter(exchange, "", static_cast<std::int16_t>(i)); !status) {
      return status;
    }
  }
  return {};
}

}  // namespace

bool is_parameter_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaxParameterName &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
                  c == '_';
         });
}

Result<Parameter> read_parameter(Exchange& exchange, const std::string& name) {
  if (!is_parameter_name(name)) {
    return Error{ErrorCode::kInvalidArgument,
                 "parameter '" + name.substr(0, 64) + "': the name must have 1 to " +
                     std::to_string(kMaxParameterName) + " characters: letters, digits, '_'"};
  }
  const std::string what = "reading parameter " + name;
  const Result<HeldMessage> message = ask(
      exchange,
      what,
      {},
      [&](int /*attempt*/) { return request_parameter(exchange, name, kByName); },
      [&](const HeldMessage& each) { return is_value_of(exchange, each, name); });
  if (message) return decode_parameter(exchange, *message);
  if (message.error().code != ErrorCode::kIo) return message.error();
  return Error{ErrorCode::kNotFound,
               message.error().message + ": does it have a parameter of this name?"};
}

Status set_parameter(Exchange& exchange, const std::string& name, double value) {
  const Result<Parameter> before = read_parameter(exchange, name);
  if (!before) return before.error();
  const auto rejected = [&](ErrorCode code, const std::string& why) {
    return Error{code, "parameter " + name + " = " + number_text(value) + ": " + why};
  };
  if (const std::optional<Limits> limits = integer_limits(before->type)) {
    if (!(value >= limits->least && value <= limits->most) || value != std::floor(value)) {
      return rejected(ErrorCode::kInvalidArgument,
                      "must be a whole number in [" + number_text(limits->least) + ", " +
                          number_text(limits->most) + "]");
    }
  } else if (!std::isfinite(static_cast<float>(value))) {
    return rejected(ErrorCode::kInvalidArgument, "must be finite as a float");
  }
  const float wire = wire_from_value(value, is_bytewise(exchange, before->type));
  const PayloadWriter payload = PayloadWriter(23)
                                    .put(0, wire)
                                    .put(4, exchange.target().system)
                                    .put(5, exchange.target().component)
                                    .put_text(6, name, kMaxParameterName)
                                    .put(22, before->type);
  const Result<HeldMessage> answer = ask(
      exchange,
      "setting parameter " + name,
      {},
      [&](int /*attempt*/) { return exchange.send(MessageId::kParamSet, payload); },
      [&](const HeldMessage& each) { return is_value_of(exchange, each, name); });
  if (!answer) return answer.error();
  const double kept = decode_parameter(exchange, *answer).value;
  const double sent = value_from_wire(wire, before->type, is_bytewise(exchange, before->type));
  if (kept == sent) return {};
  // An answer to an earlier request may still have been on its way.
  const Result<Parameter> after = read_parameter(exchange, name);
  if (!after) return after.error();
  if (after->value == sent) return {};
  return rejected(ErrorCode::kConflict,
                  exchange.target().name() + " keeps " + number_text(after->value));
}

Result<std::vector<Parameter>> read_all_parameters(Exchange& exchange) {
  const std::string what = "reading all parameters";
  Collected collected;
  for (int round = 0; round < kRounds && !collected.complete();) {
    const std::size_t before = collected.by_index.size();
    if (Status status = request_missing(exchange, collected); !status) {
      return status.error().in(what);
    }
    if (Status status = collect(exchange, collected); !status) return status.error().in(what);
    // Only rounds that bring nothing count.
    if (collected.by_index.size() == before) ++round;
  }
  if (!collected.complete()) {
    if (collected.count == 0) return no_answer(exchange, what, {std::chrono::seconds(1), kRounds});
    return Error{ErrorCode::kIo,
                 what + ": " + std::to_string(collected.count - collected.by_index.size()) +
                     " of " + std::to_string(collected.count) + " are missing"};
  }
  std::vector<Parameter> parameters;
  parameters.reserve(collected.by_index.size());
  for (auto& [index, parameter] : collected.by_index) parameters.push_back(std::move(parameter));
  return parameters;
}

}  // namespace overfly::flight::mavlink
