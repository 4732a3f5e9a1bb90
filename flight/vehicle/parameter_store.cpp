#include "flight/vehicle/parameter_store.hpp"

#include <algorithm>

namespace overfly::vehicle {
namespace {

using flight::mavlink::MessageId;
using flight::mavlink::PayloadReader;
using flight::mavlink::PayloadWriter;

constexpr std::uint8_t kReal32 = 9;  // MAV_PARAM_TYPE

/// The number of parameters if there is none of that name.
std::size_t index_of_parameter(const std::string& name) {
  const auto table = autopilot::parameter_table();
  return static_cast<std::size_t>(
      std::find_if(
          table.begin(), table.end(), [&](const auto& each) { return name == each.name; }) -
      table.begin());
}

}  // namespace

ParameterStore::Outcome ParameterStore::take(const flight::mavlink::Frame& frame,
                                             const Send& send,
                                             std::string& refusal) {
  const PayloadReader payload(frame.payload);
  const auto for_us = [&](std::size_t at) {
    const auto target = payload.at<std::uint8_t>(at);
    return target == 0 || target == system_;
  };
  const std::size_t count = autopilot::parameter_table().size();
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::kParamRequestList:
      for (std::size_t i = 0; for_us(0) && i < count; ++i) answer(i, frame.system, send);
      return Outcome::kAnswered;
    case MessageId::kParamRequestRead: {
      const auto asked = payload.at<std::int16_t>(0);
      const std::size_t index =
          asked >= 0 ? static_cast<std::size_t>(asked) : index_of_parameter(payload.text(4, 16));
      if (for_us(2) && index < count) answer(index, frame.system, send);
      return Outcome::kAnswered;
    }
    case MessageId::kParamSet:
      return for_us(4) ? set(frame, send, refusal) : Outcome::kAnswered;
    default:
      return Outcome::kNotMine;
  }
}

ParameterStore::Outcome ParameterStore::set(const flight::mavlink::Frame& frame,
                                            const Send& send,
                                            std::string& refusal) {
  const PayloadReader payload(frame.payload);
  const std::string name = payload.text(6, 16);
  const std::size_t index = index_of_parameter(name);
  // As autopilots do: no answer for an unknown name.
  if (index >= autopilot::parameter_table().size()) return Outcome::kAnswered;
  autopilot::Parameters changed = values_;
  Status status = autopilot::set_parameter(changed, name, payload.at<float>(0));
  if (status) status = autopilot::check(changed);
  if (status) {
    values_ = changed;
  } else {
    refusal = status.error().message;
  }
  answer(index, frame.system, send);
  return status ? Outcome::kChanged : Outcome::kRefused;
}

void ParameterStore::answer(std::size_t index, std::uint8_t system, const Send& send) const {
  const auto table = autopilot::parameter_table();
  send(MessageId::kParamValue,
       PayloadWriter(25)
           .put(0, static_cast<float>(values_.*table[index].value))
           .put(4, static_cast<std::uint16_t>(table.size()))
           .put(6, static_cast<std::uint16_t>(index))
           .put_text(8, table[index].name, 16)
           .put(24, kReal32),
       system);
}

}  // namespace overfly::vehicle
