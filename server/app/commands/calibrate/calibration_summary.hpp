// The result of `overfly calibrate` as text.
#pragma once

#include <string>

#include "server/calibration/calibration_record.hpp"

namespace overfly::app {

/// Estimates with standard deviations and, of a virtual camera, errors; coverage; residuals of
/// every view; images left out.
[[nodiscard]] std::string calibration_summary(const server::CalibrationRecord& record);

}  // namespace overfly::app
