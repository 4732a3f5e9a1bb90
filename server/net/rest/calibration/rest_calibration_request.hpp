// What clients ask of calibration sessions, parsed (docs/PROTOCOL.md, "Calibrations").
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>

#include "calibration/calibration.hpp"
#include "core/result.hpp"
#include "server/calibration/session/calibration_desk.hpp"

namespace overfly::net {

/// Errors: kInvalidArgument naming field, value and limit; here and below.
[[nodiscard]] Result<server::DeskRequest> calibration_request_from(const std::string& body);

struct SolveCommand {
  calibration::LensChoice lens;
  std::set<std::size_t> left_out;
};
[[nodiscard]] Result<SolveCommand> solve_command_from(const std::string& body);

/// Absent fields change nothing.
struct SessionControl {
  std::optional<bool> automatic;
  bool capture = false;
  bool finish = false;
  bool clear = false;
};
[[nodiscard]] Result<SessionControl> session_control_from(const std::string& body);

}  // namespace overfly::net
