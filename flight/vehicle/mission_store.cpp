#include "flight/vehicle/mission_store.hpp"

#include <utility>

namespace overfly::vehicle {
namespace {

using flight::mavlink::Frame;
using flight::mavlink::MessageId;
using flight::mavlink::PayloadReader;
using flight::mavlink::PayloadWriter;

constexpr std::int64_t kAskAgainNs = 1'000'000'000;
constexpr int kMaxAttempts = 5;

/// MAV_MISSION_RESULT.
enum : std::uint8_t {
  kAccepted = 0,
  kError = 1,
  kUnsupported = 3,
  kNoSpace = 4,
  kInvalidSequence = 13,
  kCancelled = 15,
};

}  // namespace

MissionStore::MissionStore(std::uint8_t system, Accept accept)
    : system_(system), accept_(std::move(accept)) {}

void MissionStore::acknowledge(std::uint8_t system,
                               std::uint8_t component,
                               std::uint8_t result,
                               std::uint8_t type,
                               const Send& send) const {
  send(MessageId::kMissionAck,
       PayloadWriter(8).put(0, system).put(1, component).put(2, result).put(3, type),
       system);
}

std::optional<Status> MissionStore::take(const Frame& frame,
                                         std::int64_t now_ns,
                                         const Send& send) {
  const PayloadReader payload(frame.payload);
  const auto for_us = [&](std::size_t at) {
    const auto target = payload.at<std::uint8_t>(at);
    return target == 0 || target == system_;
  };
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::kMissionCount:
      if (for_us(2)) begin_upload(frame, now_ns, send);
      return Status{};
    case MessageId::kMissionItemInt:
    case MessageId::kMissionItem:
      return for_us(32) ? take_item(frame, now_ns, send) : Status{};
    case MessageId::kMissionRequestList: {
      const auto type = payload.at<std::uint8_t>(2);
      if (!for_us(0)) return Status{};
      send(MessageId::kMissionCount,
           PayloadWriter(9)
               .put(0, static_cast<std::uint16_t>(type == 0 ? items_.size() : 0))
               .put(2, frame.system)
               .put(3, frame.component)
               .put(4, type),
           frame.system);
      return Status{};
    }
    case MessageId::kMissionRequest:
    case MessageId::kMissionRequestInt: {
      const auto index = payload.at<std::uint16_t>(0);
      if (!for_us(2)) return Status{};
      if (payload.at<std::uint8_t>(4) != 0 || index >= items_.size()) {
        acknowledge(
            frame.system, frame.component, kInvalidSequence, payload.at<std::uint8_t>(4), send);
        return Status{};
      }
      send(MessageId::kMissionItemInt,
           encode_mission_item(items_[index], index, frame.system, frame.component),
           frame.system);
      return Status{};
    }
    case MessageId::kMissionClearAll: {
      const auto type = payload.at<std::uint8_t>(2);
      if (!for_us(0)) return Status{};
      constexpr std::uint8_t kAll = 255;
      if (type == 0 || type == kAll) items_.clear();
      acknowledge(frame.system, frame.component, kAccepted, type, send);
      return Status{};
    }
    case MessageId::kMissionAck:
      return Status{};
    default:
      return std::nullopt;
  }
}

void MissionStore::begin_upload(const Frame& frame, std::int64_t now_ns, const Send& send) {
  const PayloadReader payload(frame.payload);
  const std::size_t count = payload.at<std::uint16_t>(0);
  const auto type = payload.at<std::uint8_t>(4);
  upload_.reset();
  const auto refuse = [&](std::uint8_t result) {
    acknowledge(frame.system, frame.component, result, type, send);
  };
  if (type != 0) return refuse(count == 0 ? kAccepted : kUnsupported);
  if (count > flight::mavlink::kMaxMissionItems) return refuse(kNoSpace);
  if (count == 0) {
    items_.clear();
    return refuse(kAccepted);
  }
  upload_ = Upload{frame.system, frame.component, count, {}, now_ns, 0};
  ask_for_next(now_ns, send);
}

void MissionStore::ask_for_next(std::int64_t now_ns, const Send& send) {
  upload_->asked_ns = now_ns;
  send(MessageId::kMissionRequestInt,
       PayloadWriter(5)
           .put(0, static_cast<std::uint16_t>(upload_->items.size()))
           .put(2, upload_->from_system)
           .put(3, upload_->from_component),
       upload_->from_system);
}

Status MissionStore::take_item(const Frame& frame, std::int64_t now_ns, const Send& send) {
  const PayloadReader payload(frame.payload);
  const bool integers = static_cast<MessageId>(frame.message_id) == MessageId::kMissionItemInt;
  if (!upload_ || frame.system != upload_->from_system || payload.at<std::uint8_t>(37) != 0) {
    return {};
  }
  // Late copies of earlier items are normal on a bad link.
  if (payload.at<std::uint16_t>(28) != upload_->items.size()) return {};
  upload_->items.push_back(flight::mavlink::decode_mission_item(payload, integers));
  upload_->attempts = 0;
  if (upload_->items.size() < upload_->count) {
    ask_for_next(now_ns, send);
    return {};
  }
  Items received = std::move(upload_->items);
  upload_.reset();
  Status accepted = accept_(received);
  if (accepted) items_ = std::move(received);
  acknowledge(frame.system, frame.component, accepted ? kAccepted : kError, 0, send);
  return accepted;
}

void MissionStore::step(std::int64_t now_ns, const Send& send) {
  if (!upload_ || now_ns - upload_->asked_ns < kAskAgainNs) return;
  if (++upload_->attempts > kMaxAttempts) {
    acknowledge(upload_->from_system, upload_->from_component, kCancelled, 0, send);
    upload_.reset();
    return;
  }
  ask_for_next(now_ns, send);
}

}  // namespace overfly::vehicle
