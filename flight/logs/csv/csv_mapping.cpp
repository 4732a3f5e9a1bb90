#include "flight/logs/csv/csv_mapping.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <string_view>
#include <utility>

#include "core/motion/pose.hpp"
#include "core/outside/file_text.hpp"
#include "core/outside/outside_json.hpp"
#include "core/time.hpp"
#include "flight/logs/csv/mapping_object.hpp"

namespace overfly::flight::logs {
namespace {

constexpr std::uint64_t kMaxMappingBytes = 1U << 20U;
constexpr std::size_t kMaxColumnNameBytes = 200;
constexpr std::size_t kMaxPathBytes = 4096;
constexpr std::string_view kVersionKey = "\"csv_mapping_version\"";

constexpr std::array<std::pair<const char*, std::int64_t>, 4> kTimeUnits{
    {{"s", kNsPerS}, {"ms", 1'000'000}, {"us", 1'000}, {"ns", 1}}};

template <typename Units>
std::string names_of_units(const Units& units) {
  std::string names;
  for (const auto& unit : units) {
    if constexpr (requires { unit.name; }) {
      names += (names.empty() ? "" : ", ") + std::string(unit.name);
    } else {
      names += (names.empty() ? "" : ", ") + std::string(unit.first);
    }
  }
  return names;
}

Result<double> unit_factor(const MappingObject& column, Dimension dimension) {
  if (dimension == Dimension::kNumber) {
    if (column.has("unit")) return column.fault("unit", "a part of a quaternion has no unit");
    return 1.0;
  }
  const Result<std::string> name = column.text("unit", kMaxColumnNameBytes);
  if (!name) return name.error();
  const std::span<const Unit> units = units_of(dimension);
  for (const Unit& unit : units) {
    if (unit.name != *name) continue;
    return dimension == Dimension::kRadians ? rad_from_deg(unit.factor) : unit.factor;
  }
  return column.fault("unit", "must be one of " + names_of_units(units));
}

Result<CsvColumn> column_from(const MappingObject& object, Dimension dimension) {
  if (Status status = object.expect_members({"column", "unit", "scale"}); !status) {
    return status.error();
  }
  const Result<std::string> name = object.text("column", kMaxColumnNameBytes);
  if (!name) return name.error();
  const Result<double> factor = unit_factor(object, dimension);
  if (!factor) return factor.error();
  CsvColumn column{*name, *factor};
  if (!object.has("scale")) return column;
  const Result<double> scale = object.number("scale", 1e12);
  if (!scale) return scale.error();
  if (*scale == 0.0) return object.fault("scale", "must not be 0");
  column.factor *= *scale;
  return column;
}

Status take_columns(const MappingObject& piece, CsvPiece& result) {
  const Result<MappingObject> columns = piece.object("columns");
  if (!columns) return columns.error();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kCsvQuantities; ++i) names.emplace_back(facts_of(i).name);
  if (Status status = columns->expect_members(names); !status) return status;
  for (std::size_t i = 0; i < kCsvQuantities; ++i) {
    if (!columns->has(names[i])) continue;
    const Result<MappingObject> object = columns->object(names[i]);
    if (!object) return object.error();
    Result<CsvColumn> column = column_from(*object, facts_of(i).dimension);
    if (!column) return column.error();
    result.columns[i] = std::move(*column);
  }
  // The first of each group stands for the group from here on.
  for (const QuantityGroup& group : quantity_groups()) {
    for (std::size_t i = group.first + 1; i < group.first + group.count; ++i) {
      if (result.columns[i].has_value() == result.columns[group.first].has_value()) continue;
      return columns->fault("", std::string("needs all or none of ") + group.names);
    }
  }
  if (result.has_angles() && result.has_quaternion()) {
    return columns->fault("", "must have either roll, pitch, yaw or qw, qx, qy, qz");
  }
  return {};
}

Status take_time(const MappingObject& piece, CsvPiece& result) {
  const Result<MappingObject> time = piece.object("time");
  if (!time) return time.error();
  if (Status status = time->expect_members({"column", "unit", "offset_s"}); !status) return status;
  const Result<std::string> column = time->text("column", kMaxColumnNameBytes);
  if (!column) return column.error();
  result.time_column = *column;
  const Result<std::string> unit = time->text("unit", kMaxColumnNameBytes);
  if (!unit) return unit.error();
  const auto known = std::find_if(kTimeUnits.begin(), kTimeUnits.end(), [&](const auto& entry) {
    return entry.first == *unit;
  });
  if (known == kTimeUnits.end()) {
    return time->fault("unit", "must be one of " + names_of_units(kTimeUnits));
  }
  result.time_unit_ns = known->second;
  if (!time->has("offset_s")) return {};
  const Result<double> offset_s = time->number("offset_s", 4e9);
  if (!offset_s) return offset_s.error();
  result.time_offset_ns = ns_from_s(*offset_s);
  return {};
}

Status take_origin(const MappingObject& piece, CsvPiece& result) {
  const bool source = result.has_position() || result.has_angles() || result.has_quaternion();
  if (!source) {
    if (piece.has("origin")) {
      return piece.fault("origin", "is only for pieces with a position or an attitude");
    }
    return {};
  }
  const Result<std::string> name = piece.text("origin", kMaxColumnNameBytes);
  if (!name) return name.error();
  for (const SourceOrigin origin :
       {SourceOrigin::kSimulation, SourceOrigin::kEstimate, SourceOrigin::kGps}) {
    if (*name != to_string(origin)) continue;
    result.origin = origin;
    return {};
  }
  return piece.fault("origin", "must be one of simulation, estimate, gps");
}

Status take_valid(const MappingObject& piece, CsvPiece& result) {
  if (!piece.has("valid")) return {};
  const Result<MappingObject> valid = piece.object("valid");
  if (!valid) return valid.error();
  if (Status status = valid->expect_members({"column", "at_least"}); !status) return status;
  const Result<std::string> column = valid->text("column", kMaxColumnNameBytes);
  if (!column) return column.error();
  const Result<double> at_least = valid->number("at_least", 1e12);
  if (!at_least) return at_least.error();
  result.valid_column = *column;
  result.valid_at_least = *at_least;
  return {};
}

/// Where the pieces lie: as a scenario, a mapping may name a data folder, which OVERFLY_DATA
/// replaces.
struct PieceFolders {
  std::filesystem::path mapping;
  std::filesystem::path data;

  [[nodiscard]] std::filesystem::path find(const std::string& file) const {
    const bool beside = file.starts_with("./") || file.starts_with("../");
    return ((beside ? mapping : data) / file).lexically_normal();
  }
};

Result<PieceFolders> folders_from(const MappingObject& mapping, const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  if (!mapping.has("data")) return PieceFolders{folder, folder};
  const Result<std::string> data = mapping.text("data", kMaxPathBytes);
  if (!data) return data.error();
  const char* const replaced = std::getenv("OVERFLY_DATA");
  if (replaced != nullptr && *replaced != '\0') return PieceFolders{folder, replaced};
  return PieceFolders{folder, folder / *data};
}

Result<CsvPiece> piece_from(const MappingObject& object, const PieceFolders& folders) {
  if (Status status = object.expect_members({"name", "file", "origin", "time", "valid", "columns"});
      !status) {
    return status.error();
  }
  CsvPiece piece;
  const Result<std::string> name = object.text("name", kMaxColumnNameBytes);
  if (!name) return name.error();
  piece.name = *name;
  const Result<std::string> file = object.text("file", kMaxPathBytes);
  if (!file) return file.error();
  piece.file = folders.find(*file);
  if (Status status = take_columns(object, piece); !status) return status.error();
  for (const auto take : {take_time, take_origin, take_valid}) {
    if (Status status = take(object, piece); !status) return status.error();
  }
  return piece;
}

}  // namespace

bool CsvPiece::has_samples() const {
  if (has_position() && origin == SourceOrigin::kGps) return true;
  for (auto i = static_cast<std::size_t>(CsvQuantity::kRateX); i < kCsvQuantities; ++i) {
    if (columns[i]) return true;
  }
  return false;
}

bool is_csv_mapping(std::span<const std::uint8_t> head) {
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{' &&
         text.find(kVersionKey) != std::string_view::npos;
}

Result<std::vector<CsvPiece>> read_csv_mapping(const std::filesystem::path& file) {
  const Result<std::string> text = read_file_text(file, kMaxMappingBytes);
  if (!text) return text.error();
  const Result<MappingJson> json = json_from_outside<MappingJson>(*text, file.string());
  if (!json) return json.error();
  const MappingObject mapping(*json, file.string(), "");
  if (Status status =
          mapping.expect_members({"csv_mapping_version", "description", "data", "pieces"});
      !status) {
    return status.error();
  }
  if (!mapping.has("csv_mapping_version") || json->at("csv_mapping_version") != 1) {
    return mapping.fault("csv_mapping_version", "must be 1");
  }
  if (!mapping.has("pieces") || !json->at("pieces").is_array() || json->at("pieces").empty() ||
      json->at("pieces").size() > kMaxCsvPieces) {
    return mapping.fault("pieces",
                         "must be a list of 1 to " + std::to_string(kMaxCsvPieces) + " objects");
  }
  const Result<PieceFolders> folders = folders_from(mapping, file);
  if (!folders) return folders.error();
  std::vector<CsvPiece> pieces;
  std::set<std::string> names;
  for (const MappingJson& entry : json->at("pieces")) {
    const std::string path = "pieces." + std::to_string(pieces.size());
    const MappingObject object(entry, file.string(), path);
    Result<CsvPiece> piece = piece_from(object, *folders);
    if (!piece) return piece.error();
    if (!names.insert(piece->name).second) return object.fault("name", "another piece has it");
    pieces.push_back(std::move(*piece));
  }
  return pieces;
}

}  // namespace overfly::flight::logs
