// Constants, headers and text of the process protocol (docs/VO_PROTOCOL.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace overfly::process {

inline constexpr std::uint16_t kProtocolVersion = 1;
inline constexpr std::string_view kMagic = "OVVO";
inline constexpr std::size_t kHeaderBytes = 12;
inline constexpr std::size_t kTextLimitBytes = 65536;
inline constexpr std::size_t kMapPointLimit = 1'000'000;
/// Maximum number of pixels of a FRAME through the socket: 8192 x 8192.
inline constexpr std::size_t kFramePixelLimit = std::size_t{64} << 20U;
/// Maximum size of a FRAME: those pixels, and 1 MiB for the fields before them.
inline constexpr std::size_t kFrameLimitBytes = std::size_t{65} << 20U;

enum class MessageType : std::uint16_t {
  kHello = 1,
  kReady = 2,
  kCalibration = 3,
  kFrame = 4,
  kAnswer = 5,
  kDebugImage = 6,
  kMapPoints = 7,
  kParameters = 8,
  kLog = 9,
  kStop = 11,
  kSensors = 12,
};

/// "HELLO", ...; "message 99" for an undefined number.
[[nodiscard]] std::string name_of(MessageType type);
/// Maximum payload of a message; `frame_pixels` of the current frame. Empty for a message that an
/// estimator must not send.
[[nodiscard]] std::optional<std::size_t> payload_limit_bytes(MessageType type,
                                                             std::size_t frame_pixels);

struct Message {
  MessageType type = MessageType::kHello;
  std::string payload;
};

/// Appends little-endian numbers.
class ByteWriter {
 public:
  ByteWriter& u16(std::uint16_t value) { return put(value, 2); }
  ByteWriter& u32(std::uint32_t value) { return put(value, 4); }
  ByteWriter& i64(std::int64_t value) { return put(static_cast<std::uint64_t>(value), 8); }
  ByteWriter& f64(double value);
  ByteWriter& text(std::string_view value);
  [[nodiscard]] std::string& bytes() { return bytes_; }

 private:
  ByteWriter& put(std::uint64_t bits, int count);
  std::string bytes_;
};

/// Reads little-endian numbers; after the end it returns 0 and `complete` is false.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  std::uint16_t u16() { return static_cast<std::uint16_t>(take(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(take(4)); }
  std::int64_t i64() { return static_cast<std::int64_t>(take(8)); }
  double f64();
  float f32();
  [[nodiscard]] std::string_view rest() const { return bytes_; }
  [[nodiscard]] bool complete() const { return complete_; }

 private:
  std::uint64_t take(std::size_t count);
  std::string_view bytes_;
  bool complete_ = true;
};

/// A header for `payload_bytes` of payload.
[[nodiscard]] std::string header_of(MessageType type, std::size_t payload_bytes);
/// Header and payload.
[[nodiscard]] std::string message_of(MessageType type, std::string_view payload = {});

/// Splits "key value" lines: the key ends at the first space.
[[nodiscard]] std::vector<std::pair<std::string_view, std::string_view>> lines_of(
    std::string_view text);

/// The first bytes in hexadecimal and as text, to quote invalid data in errors.
[[nodiscard]] std::string shown(std::string_view bytes);

}  // namespace overfly::process
