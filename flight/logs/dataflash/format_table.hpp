// The formats that a DataFlash log declares, with units and multipliers. Private to dataflash.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "flight/logs/dataflash/record_format.hpp"

namespace overfly::flight::logs {

/// Collects the records FMT, UNIT, MULT and FMTU, in whatever order they come.
class FormatTable {
 public:
  /// Starts with the format of FMT itself.
  FormatTable();

  /// The format of a type; null if it is not declared.
  [[nodiscard]] const RecordFormat* format(std::uint8_t type) const {
    return formats_[type] ? &*formats_[type] : nullptr;
  }
  /// Takes a record that declares something. @return the types whose format changed
  struct Change {
    bool any = false;
    std::uint8_t type = 0;
  };
  Change take(const RecordFormat& format, std::span<const std::uint8_t> record);

  /// FMT records that declare nothing usable.
  [[nodiscard]] std::uint64_t unusable() const { return unusable_; }
  /// FMT records that declare a type a second time, and differently.
  [[nodiscard]] std::uint64_t redeclared() const { return redeclared_; }

 private:
  Change take_format(std::span<const std::uint8_t> record);
  Change take_units(const RecordFormat& format, std::span<const std::uint8_t> record);
  void apply_units(std::uint8_t type);

  struct UnitIds {
    std::string units;
    std::string multipliers;
  };
  std::array<std::optional<RecordFormat>, 256> formats_;
  std::array<std::optional<UnitIds>, 256> unit_ids_;  ///< of FMTU, by record type
  std::array<std::string, 128> units_;                ///< of UNIT, by id
  std::array<std::optional<double>, 128> multipliers_;
  std::uint64_t unusable_ = 0;
  std::uint64_t redeclared_ = 0;
};

}  // namespace overfly::flight::logs
