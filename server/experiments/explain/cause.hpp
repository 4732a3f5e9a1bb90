// What may have made an estimator fail, by name.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace overfly::server::experiments {

enum class Cause {
  kFaults,          ///< injected faults other than dropped frames
  kDrops,           ///< frames that never reached the estimator
  kCalibration,     ///< intrinsics that the estimator gets, instead of the true ones
  kBlur,            ///< motion blur and defocus
  kRollingShutter,  ///< rows exposed one after the other
  kExposure,        ///< automatic or wrong exposure, saturation, vignetting
  kNoise,           ///< of the sensor, and its quantisation
  kTurbulence,      ///< gusts, and vibration of the camera
  kTexture,         ///< too little detail on the ground
  kRollRate,        ///< the course's roll rate
  kFeatures,        ///< the number of features that the estimator may use
  kStart,           ///< the instant at which the estimator starts
};

[[nodiscard]] const char* to_string(Cause cause);  ///< "faults", "rolling_shutter", ...
[[nodiscard]] std::optional<Cause> cause_from(const std::string& text);
[[nodiscard]] const std::vector<Cause>& all_causes();

/// Disturbances are there or not, and can be taken away. The others are properties of every flight
/// (texture, roll rate, features, start), and can only be changed.
[[nodiscard]] bool is_disturbance(Cause cause);

[[nodiscard]] bool holds(const std::vector<Cause>& causes, Cause cause);

/// What the cause is called in a sentence: "motion blur", "the course's roll rate".
[[nodiscard]] std::string words_for(Cause cause);
/// What a flight without it is called: "without blur", "roll rate halved".
[[nodiscard]] std::string words_without(Cause cause);

}  // namespace overfly::server::experiments
