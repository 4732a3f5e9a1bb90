// Cameras whose intrinsics come from a calibration file.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/outside/source_policy.hpp"
#include "core/result.hpp"

namespace overfly::server {

/// Replaces `calibration` of each camera by the fields of the file that it names: size, focal
/// lengths, principal point and distortion. The document then is complete without the file.
/// @param document  valid by the schema, without defaults
/// @param base      absolute folder of the scenario file
/// @param sources   files that may be named; checked before a file is opened
/// Errors: kInvalidArgument for a field that the file determines; as SourcePolicy::check and
/// read_calibrated_camera.
[[nodiscard]] Status read_calibrations(nlohmann::json& document,
                                       const std::filesystem::path& base,
                                       const SourcePolicy& sources);

}  // namespace overfly::server
