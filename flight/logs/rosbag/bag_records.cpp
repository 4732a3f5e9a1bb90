#include "flight/logs/rosbag/bag_records.hpp"

#include <bit>
#include <cstring>

namespace overfly::flight::logs {
namespace {

static_assert(std::endian::native == std::endian::little, "bags are little-endian");
constexpr std::size_t kLengthBytes = 4;

/// @pre bytes.size() >= kLengthBytes
std::uint32_t length_at(std::span<const std::uint8_t> bytes) {
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data(), sizeof length);
  return length;
}

}  // namespace

std::optional<std::span<const std::uint8_t>> bag_field(std::span<const std::uint8_t> fields,
                                                       std::string_view name) {
  while (fields.size() >= kLengthBytes) {
    const std::size_t length = length_at(fields);
    fields = fields.subspan(kLengthBytes);
    if (length > fields.size()) return std::nullopt;
    const std::string_view field(reinterpret_cast<const char*>(fields.data()), length);
    if (field.size() > name.size() && field.starts_with(name) && field[name.size()] == '=') {
      return fields.subspan(name.size() + 1, length - name.size() - 1);
    }
    fields = fields.subspan(length);
  }
  return std::nullopt;
}

std::string_view bag_text(std::span<const std::uint8_t> fields, std::string_view name) {
  const auto value = bag_field(fields, name);
  if (!value) return {};
  return {reinterpret_cast<const char*>(value->data()), value->size()};
}

std::optional<std::uint32_t> bag_number(std::span<const std::uint8_t> fields,
                                        std::string_view name) {
  const auto value = bag_field(fields, name);
  if (!value || value->size() != kLengthBytes) return std::nullopt;
  return length_at(*value);
}

BagOp BagRecord::op() const {
  const auto value = bag_field(header, "op");
  return value && value->size() == 1 ? static_cast<BagOp>((*value)[0]) : BagOp::kNone;
}

std::optional<BagRecord> bag_record_at(std::span<const std::uint8_t> bytes, bool* impossible) {
  *impossible = false;
  if (bytes.size() < kLengthBytes) return std::nullopt;
  const std::size_t header_bytes = length_at(bytes);
  *impossible = header_bytes > kMaxBagHeaderBytes;
  if (*impossible || bytes.size() < 2 * kLengthBytes + header_bytes) return std::nullopt;
  BagRecord record;
  record.header = bytes.subspan(kLengthBytes, header_bytes);
  record.data_at = 2 * kLengthBytes + header_bytes;
  record.data_bytes = length_at(bytes.subspan(kLengthBytes + header_bytes));
  *impossible = record.op() == BagOp::kNone;
  if (*impossible) return std::nullopt;
  return record;
}

}  // namespace overfly::flight::logs
