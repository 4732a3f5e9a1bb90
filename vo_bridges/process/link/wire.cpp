#include "vo_bridges/process/link/wire.hpp"

#include <array>
#include <bit>
#include <cstdio>

#include "vo_bridges/estimator_text.hpp"

namespace overfly::process {

namespace {

constexpr std::array<const char*, 13> kNames = {"message 0",
                                                "HELLO",
                                                "READY",
                                                "CALIBRATION",
                                                "FRAME",
                                                "ANSWER",
                                                "DEBUG_IMAGE",
                                                "MAP_POINTS",
                                                "PARAMETERS",
                                                "LOG",
                                                "message 10",
                                                "STOP",
                                                "SENSORS"};

}  // namespace

std::string name_of(MessageType type) {
  const auto number = static_cast<std::size_t>(type);
  return number < kNames.size() ? kNames[number] : "message " + std::to_string(number);
}

std::optional<std::size_t> payload_limit_bytes(MessageType type, std::size_t frame_pixels) {
  switch (type) {
    case MessageType::kHello:
    case MessageType::kParameters:
      return kTextLimitBytes;
    case MessageType::kReady:
      return 4;
    case MessageType::kAnswer:
      return 88 + kTextLimitBytes;
    case MessageType::kDebugImage:
      return 24 + 3 * frame_pixels;
    case MessageType::kMapPoints:
      return 16 + 12 * kMapPointLimit;
    case MessageType::kLog:
      return 4 + kLogLineLimitBytes;
    default:
      return std::nullopt;
  }
}

ByteWriter& ByteWriter::put(std::uint64_t bits, int count) {
  for (int i = 0; i < count; ++i) bytes_.push_back(static_cast<char>((bits >> (8 * i)) & 0xFFU));
  return *this;
}

ByteWriter& ByteWriter::f64(double value) { return put(std::bit_cast<std::uint64_t>(value), 8); }

ByteWriter& ByteWriter::text(std::string_view value) {
  bytes_ += value;
  return *this;
}

std::uint64_t ByteReader::take(std::size_t count) {
  if (bytes_.size() < count) {
    complete_ = false;
    bytes_ = {};
    return 0;
  }
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    bits |= std::uint64_t{static_cast<unsigned char>(bytes_[i])} << (8 * i);
  }
  bytes_.remove_prefix(count);
  return bits;
}

double ByteReader::f64() { return std::bit_cast<double>(take(8)); }
float ByteReader::f32() { return std::bit_cast<float>(static_cast<std::uint32_t>(take(4))); }

std::string header_of(MessageType type, std::size_t payload_bytes) {
  ByteWriter writer;
  writer.text(kMagic).u16(kProtocolVersion).u16(static_cast<std::uint16_t>(type));
  writer.u32(static_cast<std::uint32_t>(payload_bytes));
  return std::move(writer.bytes());
}

std::string message_of(MessageType type, std::string_view payload) {
  return header_of(type, payload.size()).append(payload);
}

std::vector<std::pair<std::string_view, std::string_view>> lines_of(std::string_view text) {
  std::vector<std::pair<std::string_view, std::string_view>> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (line.empty()) continue;
    const std::size_t space = line.find(' ');
    lines.emplace_back(
        line.substr(0, space),
        space == std::string_view::npos ? std::string_view{} : line.substr(space + 1));
  }
  return lines;
}

std::string shown(std::string_view bytes) {
  constexpr std::size_t kShown = 16;
  const std::string_view first = bytes.substr(0, kShown);
  std::string text;
  for (const char byte : first) {
    std::array<char, 4> hex{};
    std::snprintf(hex.data(), hex.size(), "%02X ", static_cast<unsigned char>(byte));
    text += hex.data();
  }
  return text + "(\"" + printable(first) + (bytes.size() > kShown ? "...\")" : "\")");
}

}  // namespace overfly::process
