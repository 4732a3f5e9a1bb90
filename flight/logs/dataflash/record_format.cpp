#include "flight/logs/dataflash/record_format.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/text/printable_text.hpp"

namespace overfly::flight::logs {
namespace {

static_assert(std::endian::native == std::endian::little, "records are little-endian");

struct LetterFacts {
  char letter;
  std::size_t size;
  double scale;
};

/// Letters of the FMT record (AP_Logger/LogStructure).
constexpr LetterFacts kLetters[] = {
    {'a', 64, 1.0}, {'b', 1, 1.0},  {'B', 1, 1.0},  {'h', 2, 1.0},  {'H', 2, 1.0},  {'i', 4, 1.0},
    {'I', 4, 1.0},  {'f', 4, 1.0},  {'d', 8, 1.0},  {'n', 4, 1.0},  {'N', 16, 1.0}, {'Z', 64, 1.0},
    {'c', 2, 0.01}, {'C', 2, 0.01}, {'e', 4, 0.01}, {'E', 4, 0.01}, {'L', 4, 1e-7}, {'M', 1, 1.0},
    {'q', 8, 1.0},  {'Q', 8, 1.0},  {'g', 2, 1.0}};

const LetterFacts* facts_of(char letter) {
  for (const LetterFacts& facts : kLetters) {
    if (facts.letter == letter) return &facts;
  }
  return nullptr;
}

template <typename T>
T little_endian(const RecordField& field, std::span<const std::uint8_t> record) {
  T value{};
  std::memcpy(&value, record.data() + field.offset, sizeof value);
  return value;
}

/// IEEE 754 binary16.
double half_float(std::uint16_t bits) {
  const int exponent = (bits >> 10U) & 0x1F;
  const double fraction = (bits & 0x3FFU) / 1024.0;
  double value = std::ldexp(1.0 + fraction, exponent - 15);
  if (exponent == 0) value = std::ldexp(fraction, -14);
  if (exponent == 31) {
    value = fraction == 0.0 ? std::numeric_limits<double>::infinity()
                            : std::numeric_limits<double>::quiet_NaN();
  }
  return (bits & 0x8000U) != 0 ? -value : value;
}

/// The text before the next comma, which is taken off as well.
std::string take_label(std::string& labels) {
  const std::size_t comma = std::min(labels.find(','), labels.size());
  std::string label = labels.substr(0, comma);
  labels.erase(0, comma + 1);
  return label;
}

}  // namespace

const RecordField* RecordFormat::field(std::string_view wanted) const {
  for (const RecordField& candidate : fields) {
    if (candidate.name == wanted) return &candidate;
  }
  return nullptr;
}

std::optional<RecordFormat> read_format(std::span<const std::uint8_t> record) {
  RecordFormat format;
  format.type = record[3];
  format.size_bytes = record[4];
  format.name = printable_text(record.subspan(5, 4));
  if (format.size_bytes < kRecordHeaderBytes || format.name.empty()) return std::nullopt;
  if (format.type == kFormatType && format.size_bytes != kFormatRecordBytes) return std::nullopt;
  const std::string letters = printable_text(record.subspan(9, 16));
  std::string labels = printable_text(record.subspan(25, 64));
  std::size_t offset = kRecordHeaderBytes;
  for (const char letter : letters) {
    const LetterFacts* const facts = facts_of(letter);
    if (facts == nullptr || offset + facts->size > format.size_bytes) break;
    format.fields.push_back({take_label(labels), letter, offset, facts->size, facts->scale, ""});
    offset += facts->size;
  }
  return format;
}

std::int64_t integer_in(const RecordField& field, std::span<const std::uint8_t> record) {
  switch (field.letter) {
    case 'b':
      return little_endian<std::int8_t>(field, record);
    case 'B':
    case 'M':
      return little_endian<std::uint8_t>(field, record);
    case 'h':
    case 'c':
      return little_endian<std::int16_t>(field, record);
    case 'H':
    case 'C':
      return little_endian<std::uint16_t>(field, record);
    case 'i':
    case 'e':
    case 'L':
      return little_endian<std::int32_t>(field, record);
    case 'I':
    case 'E':
      return little_endian<std::uint32_t>(field, record);
    case 'q':
    case 'Q':
      return little_endian<std::int64_t>(field, record);
    default:
      return 0;
  }
}

double number_in(const RecordField& field, std::span<const std::uint8_t> record) {
  switch (field.letter) {
    case 'f':
      return little_endian<float>(field, record) * field.scale;
    case 'd':
      return little_endian<double>(field, record) * field.scale;
    case 'g':
      return half_float(little_endian<std::uint16_t>(field, record)) * field.scale;
    case 'Q':
      return static_cast<double>(little_endian<std::uint64_t>(field, record)) * field.scale;
    case 'a':
    case 'n':
    case 'N':
    case 'Z':
      return std::numeric_limits<double>::quiet_NaN();
    default:
      return static_cast<double>(integer_in(field, record)) * field.scale;
  }
}

std::string text_in(const RecordField& field, std::span<const std::uint8_t> record) {
  return printable_text(record.subspan(field.offset, field.size));
}

}  // namespace overfly::flight::logs
