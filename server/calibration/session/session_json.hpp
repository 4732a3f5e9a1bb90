// Calibration sessions as JSON (docs/PROTOCOL.md).
#pragma once

#include <nlohmann/json.hpp>

#include "server/calibration/session/calibration_session.hpp"

namespace overfly::server {

/// The state without images, corners of older views, and the estimate itself.
[[nodiscard]] nlohmann::json session_json(const CalibrationSession& session,
                                          const SessionState& state);
/// The estimate as a calibration file, with `solution` (its number) and for each view `view` (its
/// number in the session).
[[nodiscard]] nlohmann::json solution_json(const SessionSolution& solution);
/// Corners of a view, and their distances from the projections by the estimate if it has a part in
/// it. @pre the view exists
[[nodiscard]] nlohmann::json view_json(const SessionState& state,
                                       std::size_t view,
                                       const calibration::Board& board);
[[nodiscard]] nlohmann::json board_json(const calibration::Board& board);

}  // namespace overfly::server
