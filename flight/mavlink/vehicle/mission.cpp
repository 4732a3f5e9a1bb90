#include "flight/mavlink/vehicle/mission.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace overfly::flight::mavlink {
namespace {

constexpr std::uint8_t kMissionAccepted = 0;
constexpr Patience kMissionPatience{std::chrono::milliseconds(1500), 5};
/// A vehicle may ask again for items that got lost on the way.
constexpr std::size_t kRequestsPerItem = 20;

/// Units of x and y in MISSION_ITEM_INT, per unit of MissionItem.
double scale_of(std::uint8_t frame) {
  switch (frame) {
    case 0:
    case 3:
    case 5:
    case 6:
    case 10:
    case 11:
      return 1e7;
    case 2:
      return 1.0;
    default:
      return 1e4;
  }
}

/// Without the twins of frames that only state that x and y are integers.
std::uint8_t plain_frame(std::uint8_t frame) {
  switch (frame) {
    case 5:
      return 0;
    case 6:
      return 3;
    case 11:
      return 10;
    default:
      return frame;
  }
}

std::int32_t scaled(double value, double scale) {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::lround(std::clamp(value * scale, -kMost, kMost)));
}

std::string mission_result_text(std::uint8_t type) {
  static constexpr std::array kTexts = {"accepted",
                                        "error",
                                        "unsupported frame",
                                        "unsupported",
                                        "no space",
                                        "invalid",
                                        "invalid parameter 1",
                                        "invalid parameter 2",
                                        "invalid parameter 3",
                                        "invalid parameter 4",
                                        "invalid latitude or x",
                                        "invalid longitude or y",
                                        "invalid height",
                                        "invalid sequence",
                                        "denied",
                                        "cancelled"};
  return type < kTexts.size() ? kTexts[type] : "result " + std::to_string(type);
}

/// Type of a mission: 0 is the flight plan, others are fences and rally points.
std::uint8_t type_at(const HeldMessage& message, std::size_t offset) {
  return message.reader().at<std::uint8_t>(offset);
}

bool is_request(const HeldMessage& message) {
  return (message.is(MessageId::kMissionRequest) || message.is(MessageId::kMissionRequestInt)) &&
         type_at(message, 4) == 0;
}

bool is_mission_ack(const HeldMessage& message) {
  return message.is(MessageId::kMissionAck) && type_at(message, 3) == 0;
}

bool is_item(const HeldMessage& message, std::size_t index) {
  return (message.is(MessageId::kMissionItemInt) || message.is(MessageId::kMissionItem)) &&
         type_at(message, 37) == 0 && message.reader().at<std::uint16_t>(28) == index;
}

Error rejection(const Exchange& exchange, const std::string& what, const HeldMessage& message) {
  return {ErrorCode::kConflict,
          what + ": " + exchange.target().name() + " answers '" +
              mission_result_text(message.reader().at<std::uint8_t>(2)) + "'"};
}

}  // namespace

PayloadWriter encode_mission_item(const MissionItem& item,
                                  std::size_t index,
                                  std::uint8_t system,
                                  std::uint8_t component) {
  PayloadWriter payload(38);
  for (std::size_t i = 0; i < item.parameters.size(); ++i) {
    payload.put(4 * i, item.parameters[i]);
  }
  const double scale = scale_of(item.frame);
  return payload.put(16, scaled(item.x, scale))
      .put(20, scaled(item.y, scale))
      .put(24, item.z)
      .put(28, static_cast<std::uint16_t>(index))
      .put(30, item.command)
      .put(32, system)
      .put(33, component)
      .put(34, item.frame)
      .put(35, static_cast<std::uint8_t>(item.current ? 1 : 0))
      .put(36, static_cast<std::uint8_t>(item.autocontinue ? 1 : 0));
}

MissionItem decode_mission_item(const PayloadReader& payload, bool integers) {
  MissionItem item;
  item.frame = plain_frame(payload.at<std::uint8_t>(34));
  item.command = payload.at<std::uint16_t>(30);
  item.current = payload.at<std::uint8_t>(35) != 0;
  item.autocontinue = payload.at<std::uint8_t>(36) != 0;
  for (std::size_t i = 0; i < item.parameters.size(); ++i) {
    item.parameters[i] = payload.at<float>(4 * i);
  }
  const double scale = scale_of(item.frame);
  item.x = integers ? payload.at<std::int32_t>(16) / scale : payload.at<float>(16);
  item.y = integers ? payload.at<std::int32_t>(20) / scale : payload.at<float>(20);
  item.z = payload.at<float>(24);
  return item;
}

Status upload_mission(Exchange& exchange, const std::vector<MissionItem>& items) {
  const std::string what = "uploading the mission";
  if (items.empty() || items.size() > kMaxMissionItems) {
    return Error{ErrorCode::kInvalidArgument,
                 what + ": " + std::to_string(items.size()) + " items: must be in [1, " +
                     std::to_string(kMaxMissionItems) + "]"};
  }
  const PayloadWriter count = PayloadWriter(9)
                                  .put(0, static_cast<std::uint16_t>(items.size()))
                                  .put(2, exchange.target().system)
                                  .put(3, exchange.target().component);
  std::optional<std::size_t> asked;  // the item that was asked for last
  for (std::size_t requests = 0; requests <= kRequestsPerItem * items.size(); ++requests) {
    const Result<HeldMessage> message = ask(
        exchange,
        what,
        kMissionPatience,
        [&](int /*attempt*/) {
          if (!asked) return exchange.send(MessageId::kMissionCount, count);
          return exchange.send(
              MessageId::kMissionItemInt,
              encode_mission_item(
                  items[*asked], *asked, exchange.target().system, exchange.target().component));
        },
        [&](const HeldMessage& each) {
          return is_from_target(exchange, each) && (is_request(each) || is_mission_ack(each));
        });
    if (!message) return message.error();
    if (is_mission_ack(*message)) {
      if (message->reader().at<std::uint8_t>(2) == kMissionAccepted) {
        if (asked && *asked + 1 == items.size()) return {};
        continue;  // of an earlier conversation
      }
      return rejection(exchange, what, *message);
    }
    const std::size_t index = message->reader().at<std::uint16_t>(0);
    if (index >= items.size()) {
      return Error{ErrorCode::kConflict,
                   what + ": " + exchange.target().name() + " asks for item " +
                       std::to_string(index) + " of " + std::to_string(items.size())};
    }
    asked = index;
  }
  return Error{ErrorCode::kIo,
               what + ": " + exchange.target().name() + " asked for more than " +
                   std::to_string(kRequestsPerItem) + " times the number of items"};
}

Result<std::vector<MissionItem>> download_mission(Exchange& exchange) {
  const std::string what = "downloading the mission";
  const auto to_vehicle = [&](PayloadWriter payload, std::size_t offset) {
    return payload.put(offset, exchange.target().system)
        .put(offset + 1, exchange.target().component);
  };
  const Result<HeldMessage> count = ask(
      exchange,
      what,
      kMissionPatience,
      [&](int /*attempt*/) {
        return exchange.send(MessageId::kMissionRequestList, to_vehicle(PayloadWriter(3), 0));
      },
      [&](const HeldMessage& each) {
        return is_from_target(exchange, each) &&
               (is_mission_ack(each) ||
                (each.is(MessageId::kMissionCount) && type_at(each, 4) == 0));
      });
  if (!count) return count.error();
  if (is_mission_ack(*count)) return rejection(exchange, what, *count);
  const std::size_t items = count->reader().at<std::uint16_t>(0);
  if (items > kMaxMissionItems) {
    return Error{ErrorCode::kConflict,
                 what + ": " + exchange.target().name() + " has " + std::to_string(items) +
                     " items: must be at most " + std::to_string(kMaxMissionItems)};
  }
  std::vector<MissionItem> mission;
  mission.reserve(items);
  for (std::size_t i = 0; i < items; ++i) {
    const Result<HeldMessage> item = ask(
        exchange,
        what + ": item " + std::to_string(i),
        kMissionPatience,
        [&](int /*attempt*/) {
          return exchange.send(
              MessageId::kMissionRequestInt,
              to_vehicle(PayloadWriter(5).put(0, static_cast<std::uint16_t>(i)), 2));
        },
        [&](const HeldMessage& each) {
          return is_from_target(exchange, each) && is_item(each, i);
        });
    if (!item) return item.error();
    mission.push_back(decode_mission_item(item->reader(), !item->is(MessageId::kMissionItem)));
  }
  // Ends the conversation; the vehicle does not answer.
  if (Status status = exchange.send(MessageId::kMissionAck, to_vehicle(PayloadWriter(8), 0));
      !status) {
    return status.error().in(what);
  }
  return mission;
}

}  // namespace overfly::flight::mavlink
