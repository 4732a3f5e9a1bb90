// Which flights probably have the same rendered pictures.
#pragma once

#include <string>

#include "server/scenario/scenario.hpp"

namespace overfly::server::experiments {

/// Digest of what decides a scenario's pictures before the noise of the sensor. Left out are the
/// estimators, faults, other sensors, calibration, and the stages of the sensor that act after the
/// light is rendered. The seed counts if it acts before: by turbulence, by vibration, or by noise
/// that auto-exposure with motion blur answers.
///
/// It only says whether pictures are worth keeping for other flights; the frame cache itself
/// compares what was rendered (frame_key).
[[nodiscard]] std::string picture_key(const Scenario& scenario);

}  // namespace overfly::server::experiments
