// The cameras of a scenario document.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"
#include "server/scenario/document/scenario_layers.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Reads `camera` or `cameras`, and fills in the default field of view if none is given.
/// @pre the document is valid and has its defaults; the flight and the epoch were read
/// Errors: kInvalidArgument with field, value and limit.
[[nodiscard]] Status read_cameras(nlohmann::json& document,
                                  const FileResolver& files,
                                  Scenario& scenario);

/// Reads `images` of the cameras that have them. @pre the cameras were read
[[nodiscard]] Status read_recorded_images(nlohmann::json& document,
                                          const FileResolver& files,
                                          Scenario& scenario);

/// Parts of a camera's entry. `path` is the entry's location in the document, e.g.
/// "cameras.1.sensor".
[[nodiscard]] Result<sensor::SensorModel> sensor_from(const nlohmann::json& sensor,
                                                      const std::string& path);
[[nodiscard]] Result<sensor::VibrationModel> vibration_from(const nlohmann::json& vibration,
                                                            const std::string& path);
[[nodiscard]] Result<Pose> mount_from(const nlohmann::json& mount, const std::string& path);

}  // namespace overfly::server
