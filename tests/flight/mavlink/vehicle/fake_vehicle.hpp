// A vehicle that answers at once or late, in a time of its own, and loses messages as asked
// (seeded).
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "flight/mavlink/vehicle/exchange.hpp"
#include "flight/mavlink/vehicle/mission.hpp"
#include "flight/mavlink/vehicle/parameters.hpp"

namespace overfly::flight::testing {

/// Behaves as the MAVLink developer guide describes an autopilot, as far as the operations need it.
class FakeVehicle final : public mavlink::Exchange {
 public:
  using MessageId = mavlink::MessageId;
  using Payload = mavlink::PayloadWriter;

  // What the vehicle is like:
  std::map<std::string, mavlink::Parameter> parameters;
  std::vector<std::vector<std::uint8_t>> mission;  ///< payloads of MISSION_ITEM_INT
  std::uint8_t autopilot = 3;
  std::uint8_t mission_result = 0;
  std::deque<std::uint8_t> command_results;  ///< of the next commands; accepted when empty
  std::string refusal_text;
  std::set<std::uint32_t> unknown_messages;  ///< of which no rate can be set
  bool ignores_commands = false;
  bool keeps_parameters = false;  ///< whatever is sent
  bool old_mission_requests = false;
  bool cancelled = false;
  std::optional<std::int32_t> origin_lat;  ///< of GPS_GLOBAL_ORIGIN [1e-7 deg]; empty: none yet
  double loss = 0.0;                       ///< share of messages that get lost in either direction
  bool is_mute = false;                    ///< loses all that it sends
  std::chrono::milliseconds latency{0};    ///< from an answer to its arrival
  bool has_impostor = false;  ///< component 2 gives a wrong answer before each right one
  int flood = 0;              ///< messages that wait in front of all others, one each millisecond

  // What it has got:
  std::map<std::uint32_t, int> received;  ///< by message id
  std::vector<std::vector<std::uint8_t>> commands;
  std::uint32_t mode = 0;
  bool armed = false;
  TimePoint time;

  [[nodiscard]] mavlink::Target target() const override { return {1, 1, autopilot}; }
  [[nodiscard]] TimePoint now() const override { return time; }

  [[nodiscard]] Result<std::optional<mavlink::HeldMessage>> next(TimePoint deadline) override {
    if (cancelled) return Error{ErrorCode::kCancelled, "stopped"};
    if (flood > 0) {
      --flood;
      time += std::chrono::milliseconds(1);
      return std::optional(mavlink::HeldMessage{
          static_cast<std::uint32_t>(MessageId::kAttitude), 1, Payload(28).bytes()});
    }
    while (inbox_.empty() || inbox_.front().time > time) {
      const std::chrono::seconds period(1);
      if (!inbox_.empty() && inbox_.front().time <= std::min(deadline, time + period)) {
        time = inbox_.front().time;
        break;
      }
      // A heartbeat each second while there is nothing else.
      if (time + period > deadline) {
        time = std::max(time, deadline);
        return std::optional<mavlink::HeldMessage>();
      }
      time += period;
      answer(MessageId::kHeartbeat,
             Payload(9)
                 .put(0, mode)
                 .put(4, std::uint8_t{1})
                 .put(5, autopilot)
                 .put(6, static_cast<std::uint8_t>(armed ? 0x81 : 0x01)));
    }
    std::optional<mavlink::HeldMessage> message = std::move(inbox_.front().message);
    inbox_.pop_front();
    return message;
  }

  [[nodiscard]] Status send(MessageId id, const Payload& payload) override {
    if (is_lost()) return {};
    ++received[static_cast<std::uint32_t>(id)];
    const mavlink::PayloadReader got(payload.bytes());
    switch (id) {
      case MessageId::kCommandLong:
        take_command(payload);
        break;
      case MessageId::kSetGpsGlobalOrigin:
        if (!origin_lat) origin_lat = got.at<std::int32_t>(0);
        tell_origin();
        break;
      case MessageId::kParamRequestRead:
        take_request(got);
        break;
      case MessageId::kParamRequestList:
        for (const auto& [name, parameter] : parameters) tell(parameter, index_of(name));
        break;
      case MessageId::kParamSet:
        take_set(got);
        break;
      case MessageId::kMissionCount:
        incoming_.assign(got.at<std::uint16_t>(0), {});
        ask_for_item(0);
        break;
      case MessageId::kMissionItemInt:
        take_item(payload);
        break;
      case MessageId::kMissionRequestList:
        answer(MessageId::kMissionCount,
               Payload(9).put(0, static_cast<std::uint16_t>(mission.size())));
        break;
      case MessageId::kMissionRequestInt:
        if (got.at<std::uint16_t>(0) < mission.size()) {
          std::vector<std::uint8_t> item = mission[got.at<std::uint16_t>(0)];
          item.at(32) = 255;  // the ground station, which had sent it to the vehicle
          item.at(33) = 190;
          answer(MessageId::kMissionItemInt, std::move(item));
        }
        break;
      default:
        break;
    }
    return {};
  }

  void answer(MessageId id, const Payload& payload) { answer(id, payload.bytes()); }
  void answer(MessageId id, std::vector<std::uint8_t> payload) {
    if (is_mute || is_lost()) return;
    const auto number = static_cast<std::uint32_t>(id);
    if (has_impostor) inbox_.push_back({time + latency, {number, 2, wrong(id, payload)}});
    inbox_.push_back({time + latency, {number, 1, std::move(payload)}});
  }

 private:
  struct Arrival {
    TimePoint time;
    mavlink::HeldMessage message;
  };

  /// Another count, result, value or item.
  static std::vector<std::uint8_t> wrong(MessageId id, std::vector<std::uint8_t> payload) {
    const bool has_number_first = id == MessageId::kMissionCount ||
                                  id == MessageId::kMissionRequest ||
                                  id == MessageId::kMissionRequestInt;
    std::uint8_t& changed = payload.at(has_number_first ? 0 : 2);
    changed = static_cast<std::uint8_t>(changed ^ 4U);
    return payload;
  }
  bool is_lost() {
    state_ = state_ * 1664525U + 1013904223U;
    return (state_ >> 8U) / 16777216.0 < loss;
  }

  std::uint16_t index_of(const std::string& name) {
    return static_cast<std::uint16_t>(std::distance(parameters.begin(), parameters.find(name)));
  }
  void tell(const mavlink::Parameter& parameter, std::uint16_t index) {
    float wire = static_cast<float>(parameter.value);
    if (autopilot == 12 && parameter.type != 9) {
      wire = std::bit_cast<float>(static_cast<std::int32_t>(parameter.value));
    }
    answer(MessageId::kParamValue,
           Payload(25)
               .put(0, wire)
               .put(4, static_cast<std::uint16_t>(parameters.size()))
               .put(6, index)
               .put_text(8, parameter.name, 16)
               .put(24, parameter.type));
  }
  void take_request(const mavlink::PayloadReader& got) {
    const auto index = got.at<std::int16_t>(0);
    if (index >= 0) {
      auto wanted = parameters.begin();
      std::advance(wanted, index);
      return tell(wanted->second, static_cast<std::uint16_t>(index));
    }
    const auto wanted = parameters.find(got.text(4, 16));
    if (wanted != parameters.end()) tell(wanted->second, 0xFFFF);
  }
  void take_set(const mavlink::PayloadReader& got) {
    const auto wanted = parameters.find(got.text(6, 16));
    if (wanted == parameters.end()) return;
    const auto wire = got.at<float>(0);
    const bool bytes = autopilot == 12 && wanted->second.type != 9;
    if (!keeps_parameters) {
      wanted->second.value = bytes ? std::bit_cast<std::int32_t>(wire) : double{wire};
    }
    tell(wanted->second, 0xFFFF);
  }
  void take_command(const Payload& payload) {
    if (ignores_commands) return;
    commands.push_back(payload.bytes());
    const mavlink::PayloadReader got(payload.bytes());
    const auto id = got.at<std::uint16_t>(28);
    std::uint8_t result = 0;
    if (id == 511 && unknown_messages.contains(static_cast<std::uint32_t>(got.at<float>(0)))) {
      result = 3;
    } else if (!command_results.empty()) {
      result = command_results.front();
      command_results.pop_front();
    }
    if (result == 0 && id == 400) armed = got.at<float>(0) == 1.0F;
    if (result == 0 && id == 176) mode = static_cast<std::uint32_t>(got.at<float>(4));
    if (result == 0 && id == 512 && got.at<float>(0) == 49.0F) tell_origin();
    answer(MessageId::kCommandAck, Payload(10).put(0, id).put(2, result));
    if (result == 5) answer(MessageId::kCommandAck, Payload(10).put(0, id));
    if (result != 0 && !refusal_text.empty()) {
      answer(MessageId::kStatusText, Payload(54).put_text(1, refusal_text, 50));
    }
  }
  void tell_origin() {
    if (origin_lat) answer(MessageId::kGpsGlobalOrigin, Payload(20).put(0, *origin_lat));
  }
  void ask_for_item(std::size_t index) {
    answer(old_mission_requests ? MessageId::kMissionRequest : MessageId::kMissionRequestInt,
           Payload(5).put(0, static_cast<std::uint16_t>(index)));
  }
  void take_item(const Payload& payload) {
    const std::size_t index = mavlink::PayloadReader(payload.bytes()).at<std::uint16_t>(28);
    if (index >= incoming_.size()) return;
    incoming_[index] = payload.bytes();
    const auto missing = std::find_if(
        incoming_.begin(), incoming_.end(), [](const auto& item) { return item.empty(); });
    if (missing != incoming_.end()) {
      return ask_for_item(static_cast<std::size_t>(missing - incoming_.begin()));
    }
    if (mission_result == 0) mission = incoming_;
    answer(MessageId::kMissionAck, Payload(8).put(2, mission_result));
  }

  std::deque<Arrival> inbox_;
  std::vector<std::vector<std::uint8_t>> incoming_;
  std::uint32_t state_ = 1;
};

}  // namespace overfly::flight::testing
