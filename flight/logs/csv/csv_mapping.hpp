// Describes which columns of CSV files make up a flight log.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "flight/logs/csv/csv_quantities.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// A column and the factor that turns its numbers into degrees (lat, lon), metres (alt_msl),
/// radians (roll, pitch, yaw), parts of a quaternion, rad/s, m/s^2, uT, Pa, m/s (airspeed) or
/// metres (range).
struct CsvColumn {
  std::string name;
  double factor = 1.0;
};

/// One CSV file of the flight: a stream of the log.
struct CsvPiece {
  std::string name;
  std::filesystem::path file;  ///< absolute, or relative to the working folder
  SourceOrigin origin = SourceOrigin::kNone;
  std::string time_column;
  std::int64_t time_unit_ns = 1;    ///< one unit of the column
  std::int64_t time_offset_ns = 0;  ///< added to the column's times: aligns the pieces' clocks
  /// A row holds a sample only if this column is at least that value.
  std::optional<std::string> valid_column;
  double valid_at_least = 0.0;
  std::array<std::optional<CsvColumn>, kCsvQuantities> columns;

  [[nodiscard]] const std::optional<CsvColumn>& column(CsvQuantity quantity) const {
    return columns[static_cast<std::size_t>(quantity)];
  }
  [[nodiscard]] bool has_position() const { return column(CsvQuantity::kLat).has_value(); }
  [[nodiscard]] bool has_angles() const { return column(CsvQuantity::kRoll).has_value(); }
  [[nodiscard]] bool has_quaternion() const { return column(CsvQuantity::kQw).has_value(); }
  /// Its rows are samples of sensors: positions of a receiver, or one of the quantities from rates
  /// on.
  [[nodiscard]] bool has_samples() const;
};

inline constexpr std::size_t kMaxCsvPieces = 32;

/// Whether a file starts as a mapping: an object with "csv_mapping_version" in its first bytes.
[[nodiscard]] bool is_csv_mapping(std::span<const std::uint8_t> head);

/// Reads a mapping (docs/LOGS.md). File names are relative to its data folder, which the
/// environment variable OVERFLY_DATA replaces, or else to its own folder. They are not checked or
/// opened here. Errors: as read_file_text up to 1 MiB; kUnreadable for JSON that cannot be parsed;
/// kInvalidArgument naming file, field and limit.
[[nodiscard]] Result<std::vector<CsvPiece>> read_csv_mapping(const std::filesystem::path& file);

}  // namespace overfly::flight::logs
