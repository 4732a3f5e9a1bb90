#include "flight/logs/dataflash/format_table.hpp"

#include <cmath>

namespace overfly::flight::logs {
namespace {

/// Unit id of a field that counts equal sensors or cores.
constexpr char kInstanceUnit = '#';

bool letter_has_scale(char letter) {
  return letter == 'c' || letter == 'C' || letter == 'e' || letter == 'E' || letter == 'L';
}

bool equal_layout(const RecordFormat& a, const RecordFormat& b) {
  if (a.size_bytes != b.size_bytes || a.name != b.name || a.fields.size() != b.fields.size()) {
    return false;
  }
  for (std::size_t i = 0; i < a.fields.size(); ++i) {
    if (a.fields[i].name != b.fields[i].name || a.fields[i].letter != b.fields[i].letter) {
      return false;
    }
  }
  return true;
}

/// In logs without FMTU, by the names that these fields have in all versions.
std::optional<std::size_t> instance_by_name(const RecordFormat& format) {
  for (std::size_t i = 0; i < format.fields.size(); ++i) {
    const RecordField& field = format.fields[i];
    if (field.letter == 'B' && (field.name == "I" || field.name == "C")) return i;
  }
  return std::nullopt;
}

}  // namespace

FormatTable::FormatTable() {
  RecordFormat fmt;
  fmt.type = kFormatType;
  fmt.size_bytes = kFormatRecordBytes;
  fmt.name = "FMT";
  formats_[kFormatType] = fmt;
}

FormatTable::Change FormatTable::take(const RecordFormat& format,
                                      std::span<const std::uint8_t> record) {
  if (format.type == kFormatType) return take_format(record);
  if (format.name == "FMTU") return take_units(format, record);
  const RecordField* const id = format.field("Id");
  if (id == nullptr) return {};
  const std::int64_t key = integer_in(*id, record);
  if (key < 0 || key >= static_cast<std::int64_t>(units_.size())) return {};
  if (format.name == "UNIT") {
    const RecordField* const label = format.field("Label");
    if (label != nullptr) units_[static_cast<std::size_t>(key)] = text_in(*label, record);
  } else if (format.name == "MULT") {
    const RecordField* const multiplier = format.field("Mult");
    if (multiplier != nullptr) {
      multipliers_[static_cast<std::size_t>(key)] = number_in(*multiplier, record);
    }
  }
  return {};
}

FormatTable::Change FormatTable::take_format(std::span<const std::uint8_t> record) {
  const std::optional<RecordFormat> read = read_format(record);
  if (!read) {
    ++unusable_;
    return {};
  }
  std::optional<RecordFormat>& known = formats_[read->type];
  if (read->type == kFormatType && known && !known->fields.empty()) return {};
  if (known && equal_layout(*known, *read)) return {};
  if (known && read->type != kFormatType) ++redeclared_;
  known = read;
  known->instance = instance_by_name(*read);
  apply_units(read->type);
  return {true, read->type};
}

FormatTable::Change FormatTable::take_units(const RecordFormat& format,
                                            std::span<const std::uint8_t> record) {
  const RecordField* const type = format.field("FmtType");
  const RecordField* const units = format.field("UnitIds");
  const RecordField* const multipliers = format.field("MultIds");
  if (type == nullptr || units == nullptr || multipliers == nullptr) return {};
  const auto described = static_cast<std::uint8_t>(integer_in(*type, record));
  unit_ids_[described] = UnitIds{text_in(*units, record), text_in(*multipliers, record)};
  if (!formats_[described]) return {};
  apply_units(described);
  return {true, described};
}

void FormatTable::apply_units(std::uint8_t type) {
  if (!unit_ids_[type]) return;
  const UnitIds& ids = *unit_ids_[type];
  RecordFormat& format = *formats_[type];
  for (std::size_t i = 0; i < format.fields.size(); ++i) {
    RecordField& field = format.fields[i];
    if (i < ids.units.size()) {
      const auto unit = static_cast<std::size_t>(ids.units[i]);
      if (ids.units[i] == kInstanceUnit) format.instance = i;
      if (unit < units_.size()) field.unit = units_[unit];
    }
    if (i < ids.multipliers.size() && !letter_has_scale(field.letter)) {
      const auto id = static_cast<std::size_t>(ids.multipliers[i]);
      if (id < multipliers_.size() && multipliers_[id]) {
        const double multiplier = *multipliers_[id];
        field.scale = std::isfinite(multiplier) && multiplier > 0.0 ? multiplier : 1.0;
      }
    }
  }
}

}  // namespace overfly::flight::logs
