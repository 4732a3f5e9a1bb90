// The records of ROS bags. Private to rosbag.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace overfly::flight::logs {

inline constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";

/// The kinds of records that are read (field "op" of a record's header).
enum class BagOp : std::uint8_t {
  kMessage = 0x02,
  kFileHeader = 0x03,
  kChunk = 0x05,
  kConnection = 0x07,
  kNone = 0xFF,  ///< the header has no "op"
};

/// The value of a field in a sequence of fields "name=value", each after its length (uint32_t);
/// empty without such a field, or if a field ends behind the sequence.
[[nodiscard]] std::optional<std::span<const std::uint8_t>> bag_field(
    std::span<const std::uint8_t> fields, std::string_view name);
/// As bag_field, as text; "" without such a field.
[[nodiscard]] std::string_view bag_text(std::span<const std::uint8_t> fields,
                                        std::string_view name);
/// As bag_field, as a number of 4 bytes, little-endian.
[[nodiscard]] std::optional<std::uint32_t> bag_number(std::span<const std::uint8_t> fields,
                                                      std::string_view name);

/// A record: its header's fields, and the place of its data.
struct BagRecord {
  std::span<const std::uint8_t> header;
  std::size_t data_at = 0;       ///< from the start of the record
  std::uint32_t data_bytes = 0;  ///< may reach beyond the bytes that were looked at

  [[nodiscard]] BagOp op() const;
};

/// Headers have some short fields and the name of a topic.
inline constexpr std::size_t kMaxBagHeaderBytes = 65536;

/// The record at the start of `bytes`.
/// @param impossible  set if the bytes are no record, whatever follows them
/// @return empty if the bytes end within the header, or are no record
[[nodiscard]] std::optional<BagRecord> bag_record_at(std::span<const std::uint8_t> bytes,
                                                     bool* impossible);

}  // namespace overfly::flight::logs
