#include "flight/logs/ulog/ulog_message.hpp"

#include <algorithm>
#include <string_view>

namespace overfly::flight::logs {
namespace {

constexpr std::string_view kKnownKinds = "BFIMPQARDLCSO";

bool is_known_kind(std::uint8_t kind) {
  return kKnownKinds.find(static_cast<char>(kind)) != std::string_view::npos;
}

}  // namespace

UlogPlace look_at_message(std::span<const std::uint8_t> bytes, std::uint64_t limit, bool in_step) {
  if (bytes.size() < kUlogMessageHeaderBytes || limit < kUlogMessageHeaderBytes) {
    return {UlogPlace::Kind::kCut,
            static_cast<std::size_t>(std::min<std::uint64_t>(limit, bytes.size()))};
  }
  const std::size_t size = kUlogMessageHeaderBytes + ulog_value<std::uint16_t>(bytes, 0);
  const bool known = is_known_kind(bytes[2]);
  if (size > limit) {
    if (!known || !in_step) return {UlogPlace::Kind::kDamage, 1};
    return {UlogPlace::Kind::kCut, static_cast<std::size_t>(limit)};
  }
  const std::span<const std::uint8_t> next = bytes.subspan(size);
  const bool next_known =
      size == limit || next.size() < kUlogMessageHeaderBytes || is_known_kind(next[2]);
  if (!next_known) return {UlogPlace::Kind::kDamage, 1};
  return {known ? UlogPlace::Kind::kMessage : UlogPlace::Kind::kUnknownKind, size};
}

}  // namespace overfly::flight::logs
