// Formats of DataFlash records, which the log itself declares. Private to dataflash.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace overfly::flight::logs {

inline constexpr std::uint8_t kRecordStart1 = 0xA3;
inline constexpr std::uint8_t kRecordStart2 = 0x95;
inline constexpr std::size_t kRecordHeaderBytes = 3;
/// The record that declares a format: type, length, name[4], letters[16], labels[64].
inline constexpr std::uint8_t kFormatType = 0x80;
inline constexpr std::size_t kFormatRecordBytes = 89;

/// One field of a record.
struct RecordField {
  std::string name;
  char letter = 0;         ///< type: one of "abBhHiIfdnNZcCeELMqQg"
  std::size_t offset = 0;  ///< from the start of the record
  std::size_t size = 0;    ///< [bytes]
  double scale = 1.0;      ///< from the letter (c, C, e, E: 0.01, L: 1e-7) or else from FMTU
  std::string unit;        ///< from FMTU and UNIT, "" if unknown
};

/// A kind of record.
struct RecordFormat {
  std::uint8_t type = 0;
  std::size_t size_bytes = 0;  ///< of the whole record, with its header
  std::string name;
  std::vector<RecordField> fields;
  std::optional<std::size_t> instance;  ///< index of the field that counts equal sensors or cores

  /// The field of a name; null if there is none.
  [[nodiscard]] const RecordField* field(std::string_view wanted) const;
};

/// Reads a FMT record. Fields whose letter is unknown, and those that do not fit into the length,
/// end the list of fields.
/// @param record  kFormatRecordBytes bytes
/// @return empty if the length is shorter than a header, the name is empty or the type is that of
/// FMT with another length
[[nodiscard]] std::optional<RecordFormat> read_format(std::span<const std::uint8_t> record);

/// Value of a number field, scaled; NaN for text and arrays. @param record  the whole record
[[nodiscard]] double number_in(const RecordField& field, std::span<const std::uint8_t> record);
/// Value of an integer field, not scaled; 0 for others.
[[nodiscard]] std::int64_t integer_in(const RecordField& field,
                                      std::span<const std::uint8_t> record);
/// Text up to its first zero; bytes that are not printable ASCII become '?'.
[[nodiscard]] std::string text_in(const RecordField& field, std::span<const std::uint8_t> record);

}  // namespace overfly::flight::logs
