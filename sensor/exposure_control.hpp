// Exposure control: fixed, or a controller on the mean level.
#pragma once

#include "sensor/sensor_model.hpp"

namespace overfly::sensor {

/// A damped Newton step on the logarithm of exposure times gain:
///   ln E' = ln E + alpha ln(target / mean) / slope,
/// with slope = d ln mean / d ln E = 1 - saturated / mean, because saturated pixels do not respond.
/// alpha is chosen so that 5 % of three stops remain after settle_frames frames. From below it
/// never overshoots; from a saturated image at most once.
class ExposureControl {
 public:
  explicit ExposureControl(const SensorModel& model);

  [[nodiscard]] ExposureSetting setting() const;
  /// Updates the controller with the result of the setting.
  /// @param mean_level  of the converter's numbers, without black level, in [0, 1]
  /// @param saturated_fraction  in [0, 1]
  void observe(double mean_level, double saturated_fraction);

 private:
  std::optional<AutoExposure> automatic_;
  double fixed_exposure_s_;
  double target_level_ = 0.5;  ///< of the converter's numbers
  double alpha_ = 0.0;
  double exposure_times_gain_s_;
};

}  // namespace overfly::sensor
