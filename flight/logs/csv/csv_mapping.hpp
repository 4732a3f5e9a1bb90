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
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// What a column can hold. Angles of attitudes: body (forward-right-down) relative to
/// north-east-down, intrinsic Z-Y-X; quaternions R_ned_body.
enum class CsvQuantity { kLat, kLon, kAltMsl, kRoll, kPitch, kYaw, kQw, kQx, kQy, kQz };
inline constexpr std::size_t kCsvQuantities = 10;
/// The name in a mapping: "lat", "alt_msl", "qw".
[[nodiscard]] const char* to_string(CsvQuantity quantity);

/// A column and the factor that turns its numbers into degrees (lat, lon), metres (alt_msl),
/// radians (roll, pitch, yaw) or parts of a quaternion.
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
