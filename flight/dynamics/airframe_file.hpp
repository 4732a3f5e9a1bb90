// Reads airframe files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "flight/dynamics/airframe.hpp"

namespace overfly::dynamics {

/// Reads an airframe file (JSON; docs/AIRCRAFT.md lists its fields and limits).
/// Errors: as read_file_text; kUnreadable for text that is not JSON; kInvalidArgument naming file,
/// field, value and limit, for a missing or unknown field, and for values that contradict each
/// other: an impossible inertia, an aircraft too light for its size, or a propeller that is too
/// fast, too strong, or drives without power.
[[nodiscard]] Result<Airframe> read_airframe(const std::filesystem::path& file);

/// As read_airframe, from the text of a file. @param origin  names the source in messages
[[nodiscard]] Result<Airframe> parse_airframe(std::string_view text, const std::string& origin);

}  // namespace overfly::dynamics
