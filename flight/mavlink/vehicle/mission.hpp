// Missions: files, and upload to and download from a vehicle.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "flight/mavlink/vehicle/exchange.hpp"

namespace overfly::flight::mavlink {

struct MissionItem {
  std::uint8_t frame = 3;      ///< MAV_FRAME: 0 global, 3 global with height above home
  std::uint16_t command = 16;  ///< MAV_CMD
  bool current = false;
  bool autocontinue = true;
  std::array<float, 4> parameters{};  ///< NaN: the vehicle's default
  /// Latitude and longitude [deg] in global frames, x and y [m] in local frames, plain numbers in
  /// frame 2 (MAV_FRAME_MISSION).
  double x = 0.0;
  double y = 0.0;
  float z = 0.0F;  ///< height [m], or the seventh parameter
  friend bool operator==(const MissionItem&, const MissionItem&) = default;
};

/// Of a mission file; autopilots store some hundred to a few thousand.
inline constexpr std::size_t kMaxMissionItems = 5000;

/// A mission as a ground station stored it.
struct StoredMission {
  std::vector<MissionItem> items;     ///< item 0 is the home position
  std::vector<std::string> warnings;  ///< what else the file contains, which is not flown
};

/// Whether a file begins like a plan of QGroundControl. What cannot be read is left to the reader.
[[nodiscard]] bool is_plan_file(const std::filesystem::path& file);
/// Reads a mission file of a ground station. Its content decides on the format: a plan of
/// QGroundControl (plan_file.hpp), or text with "QGC WPL 110" in its first line, then in each line
/// index, current, frame, command, four parameters, latitude, longitude, height and autocontinue.
/// Errors: as FieldFile::read and parse_plan; kUnreadable naming file, line, column, value and
/// limit.
[[nodiscard]] Result<StoredMission> read_mission_file(const std::filesystem::path& file);

/// MISSION_ITEM_INT of an item, to a system and component.
[[nodiscard]] PayloadWriter encode_mission_item(const MissionItem& item,
                                                std::size_t index,
                                                std::uint8_t system,
                                                std::uint8_t component);
/// The item of MISSION_ITEM_INT, or of MISSION_ITEM if x and y are not `integers`.
[[nodiscard]] MissionItem decode_mission_item(const PayloadReader& payload, bool integers);

/// Replaces the vehicle's mission. Positions are sent in steps of 1e-7 deg.
/// Errors: as ask(); kInvalidArgument for an empty mission or more than kMaxMissionItems; kConflict
/// if the vehicle rejects the mission, with its reason.
[[nodiscard]] Status upload_mission(Exchange& exchange, const std::vector<MissionItem>& items);

/// Errors: as ask(); kConflict if the vehicle states an error or more than kMaxMissionItems.
[[nodiscard]] Result<std::vector<MissionItem>> download_mission(Exchange& exchange);

}  // namespace overfly::flight::mavlink
