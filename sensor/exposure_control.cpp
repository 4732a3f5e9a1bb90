#include "sensor/exposure_control.hpp"

#include <algorithm>
#include <cmath>

#include "core/time.hpp"

namespace overfly::sensor {

namespace {

/// Limits the step for a black image, which shows only that more exposure is needed.
constexpr double kDarkestLevel = 1e-3;
/// The slope for a completely saturated image, which would be 0.
constexpr double kLeastSlope = 0.25;

}  // namespace

ExposureControl::ExposureControl(const SensorModel& model)
    : automatic_(model.auto_exposure),
      fixed_exposure_s_(model.exposure_s),
      exposure_times_gain_s_(model.exposure_s) {
  if (!automatic_) return;
  target_level_ = model.response.inverse(automatic_->target_mean);
  const double left = std::log(1.05) / std::log(8.0);
  alpha_ = 1.0 - std::pow(left, 1.0 / (automatic_->settle_frames - 1));
  exposure_times_gain_s_ = std::clamp(exposure_times_gain_s_,
                                      automatic_->min_exposure_s,
                                      automatic_->max_exposure_s * automatic_->max_gain);
}

ExposureSetting ExposureControl::setting() const {
  if (!automatic_) return {ns_from_s(fixed_exposure_s_), 1.0};
  const double exposure_s = std::min(exposure_times_gain_s_, automatic_->max_exposure_s);
  return {ns_from_s(exposure_s), exposure_times_gain_s_ / exposure_s};
}

void ExposureControl::observe(double mean_level, double saturated_fraction) {
  if (!automatic_) return;
  const double mean = std::max(mean_level, kDarkestLevel);
  const double slope = std::max(1.0 - saturated_fraction / mean, kLeastSlope);
  const double step = alpha_ * std::log(target_level_ / mean) / slope;
  exposure_times_gain_s_ = std::clamp(exposure_times_gain_s_ * std::exp(step),
                                      automatic_->min_exposure_s,
                                      automatic_->max_exposure_s * automatic_->max_gain);
}

}  // namespace overfly::sensor
