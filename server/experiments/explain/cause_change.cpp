#include "server/experiments/explain/cause_change.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "server/experiments/explain/fault_places.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;

constexpr double kRollRateShare = 0.5;
constexpr double kStartShift_s = 0.7;
constexpr std::int64_t kMostFeatures = 20'000;  // limit of the native estimator

/// The numbers of features of estimators, by the names of their authors.
constexpr std::array<const char*, 5> kFeatureParameters = {
    "features", "nFeatures", "ORBextractor.nFeatures", "max_fts", "maxFts"};
constexpr std::int64_t kFeaturesOfNative = 2000;

Json& estimator_of(Json& document) { return document.at("estimators").at(0); }
const Json& estimator_of(const Json& document) { return document.at("estimators").at(0); }

/// The camera whose images the estimator gets.
template <typename Document>
Document& camera_of(Document& document) {
  if (document.contains("camera")) return document.at("camera");
  const std::string name = estimator_of(document).value("camera", "");
  for (Document& camera : document.at("cameras")) {
    if (camera.value("name", "") == name) return camera;
  }
  return document.at("cameras").at(0);
}

const Json* sensor_of(const Json& document) {
  const Json& camera = camera_of(document);
  const auto sensor = camera.find("sensor");
  return sensor == camera.end() ? nullptr : &*sensor;
}

double number(const Json& object, const char* name) { return object.value(name, 0.0); }

bool is_drop(const Json& fault) { return fault.at("kind") == "dropped_frames"; }

bool concerns(const Json& document, const Json& fault, Cause cause) {
  if (!is_in_flight(document, fault)) return false;
  const std::string camera = fault.value("camera", "");
  if (!camera.empty() && camera != camera_of(document).value("name", "")) return false;
  if (fault.at("kind") == "gps_outage") return false;
  return is_drop(fault) == (cause == Cause::kDrops);
}

bool any_fault(const Json& document, Cause cause) {
  const Json faults = document.value("faults", Json::array());
  return std::any_of(faults.begin(), faults.end(), [&](const Json& fault) {
    return concerns(document, fault, cause);
  });
}

bool any_positive(const Json& object, std::initializer_list<const char*> names) {
  return std::any_of(
      names.begin(), names.end(), [&](const char* name) { return number(object, name) > 0.0; });
}

constexpr std::array<const char*, 4> kVibrations = {"engine_rotation_rms_mrad",
                                                    "engine_translation_rms_mm",
                                                    "noise_rotation_rms_mrad",
                                                    "noise_translation_rms_mm"};

bool vibrates(const Json& document) {
  const Json& camera = camera_of(document);
  const Json vibration = camera.value("vibration", Json::object());
  for (const char* name : kVibrations) {
    for (const Json& value : vibration.value(name, Json::array())) {
      if (value.get<double>() > 0.0) return true;
    }
  }
  return false;
}

/// The flight's part that has a field `turbulence`; null if it has none.
template <typename Document>
Document* air_of(Document& document) {
  for (const char* kind : {"course", "mission"}) {
    if (document.at("flight").contains(kind)) return &document.at("flight").at(kind);
  }
  return nullptr;
}

bool has_gusts(const Json& document) {
  const Json* air = air_of(document);
  return air != nullptr && air->value("turbulence", "none") != "none";
}

bool has_vignette(const Json& sensor) {
  const Json vignette = sensor.value("vignette", Json::array());
  return std::any_of(
      vignette.begin(), vignette.end(), [](const Json& a) { return a.get<double>() != 0.0; });
}

bool is_present(const Json& document, Cause cause) {
  const Json* sensor = sensor_of(document);
  switch (cause) {
    case Cause::kFaults:
      return any_fault(document, cause);
    case Cause::kDrops:
      return any_fault(document, cause) || document.value("pacing", "") == "real_time" ||
             number(estimator_of(document), "throttle_hz") > 0.0;
    case Cause::kCalibration: {
      const Json calibrated = camera_of(document).value("calibrated", Json(false));
      return calibrated.is_object() || calibrated == true;
    }
    case Cause::kBlur:
      return sensor != nullptr &&
             (sensor->value("motion_blur", false) || number(*sensor, "defocus_sigma_px") > 0.0);
    case Cause::kRollingShutter:
      return sensor != nullptr && number(*sensor, "readout_ms") > 0.0;
    case Cause::kExposure:
      return sensor != nullptr &&
             (sensor->contains("auto_exposure") || has_vignette(*sensor) ||
              any_positive(*sensor, {"gain_dn_per_e", "full_well_e", "black_level_dn"}));
    case Cause::kNoise:
      return sensor != nullptr &&
             (sensor->value("shot_noise", false) ||
              any_positive(*sensor, {"prnu", "dsnu_e", "read_noise_e", "adc_bits"}));
    case Cause::kTurbulence:
      return has_gusts(document) || vibrates(document);
    default:
      return true;
  }
}

/// The parameter that limits the number of features; empty if the estimator has none.
std::string features_parameter(const Json& estimator) {
  const Json parameters = estimator.value("parameters", Json::object());
  for (const char* name : kFeatureParameters) {
    if (parameters.contains(name) && parameters.at(name).is_number()) return name;
  }
  return estimator.value("type", "") == "feature" ? kFeatureParameters[0] : "";
}

std::int64_t features_of(const Json& estimator) {
  const Json parameters = estimator.value("parameters", Json::object());
  const std::string name = features_parameter(estimator);
  return parameters.contains(name) ? parameters.at(name).get<std::int64_t>() : kFeaturesOfNative;
}

void scale(Json& object, const char* name, double factor) {
  if (object.contains(name)) object[name] = object.at(name).get<double>() * factor;
}

void scale_fault(Json& fault, double share) {
  if (!is_drop(fault)) {
    scale(fault, "duration_s", share);
  } else if (fault.contains("probability")) {
    scale(fault, "probability", share);
  } else {
    const double every = static_cast<double>(fault.value("every", std::int64_t{1}));
    fault["every"] = static_cast<std::int64_t>(std::ceil(every / share));
  }
}

void change_faults(Json& document, Cause cause, double share) {
  Json kept = Json::array();
  for (Json fault : document.value("faults", Json::array())) {
    if (concerns(document, fault, cause)) {
      if (share > 0.0) {
        scale_fault(fault, share);
      } else {
        move_out_of_flight(fault);
      }
    }
    kept.push_back(fault);
  }
  remove_last_out_of_flight(document, kept);
  document["faults"] = kept;
}

void change_drops(Json& document, double share) {
  change_faults(document, Cause::kDrops, share);
  if (share > 0.0) return;
  document["pacing"] = "lockstep";
  estimator_of(document).erase("throttle_hz");
}

/// A shorter exposure of more light: the same brightness and noise, less blur.
void change_blur(Json& sensor, double share) {
  if (share > 0.0) {
    sensor["exposure_ms"] = number(sensor, "exposure_ms") * share;
    sensor["electrons_per_s"] = number(sensor, "electrons_per_s") / share;
    scale(sensor, "defocus_sigma_px", share);
    return;
  }
  sensor["motion_blur"] = false;
  sensor["defocus_sigma_px"] = 0.0;
}

void change_exposure(Json& sensor) {
  sensor.erase("auto_exposure");
  sensor.erase("vignette");
  for (const char* name : {"gain_dn_per_e", "full_well_e", "black_level_dn"}) sensor[name] = 0.0;
}

/// Shot noise falls with the square root of the light.
void change_noise(Json& sensor, double share) {
  for (const char* name : {"prnu", "dsnu_e", "read_noise_e"}) scale(sensor, name, share);
  if (share > 0.0) {
    // The gain follows the light, so that the other noise must too.
    const double light = sensor.value("shot_noise", false) ? 1.0 / (share * share) : 1.0;
    scale(sensor, "electrons_per_s", light);
    scale(sensor, "dsnu_e", light);
    scale(sensor, "read_noise_e", light);
    return;
  }
  sensor["shot_noise"] = false;
  sensor["adc_bits"] = 0;
}

void change_turbulence(Json& document, double share) {
  Json& camera = camera_of(document);
  if (share > 0.0) {
    for (const char* name : kVibrations) {
      for (Json& value : camera["vibration"][name]) value = value.get<double>() * share;
    }
    return;
  }
  camera.erase("vibration");
  if (Json* air = air_of(document)) (*air)["turbulence"] = "none";
}

void change_features(Json& estimator) {
  estimator["parameters"][features_parameter(estimator)] =
      std::min(kMostFeatures, 2 * features_of(estimator));
}

bool scales_faults(const Json& document, Cause cause) {
  const Json faults = document.value("faults", Json::array());
  return std::all_of(faults.begin(), faults.end(), [&](const Json& fault) {
    return !concerns(document, fault, cause) || is_drop(fault) || fault.contains("duration_s");
  });
}

}  // namespace

CauseChange without(Cause cause) {
  return {cause, cause == Cause::kRollRate ? kRollRateShare : 0.0};
}

std::optional<std::string> why_unchangeable(const Json& document, Cause cause) {
  switch (cause) {
    case Cause::kTexture:
      if (!document.contains("detail")) return std::nullopt;
      return "the scenario has synthetic detail already";
    case Cause::kRollRate:
      if (document.at("flight").contains("course")) return std::nullopt;
      return "only a course can be flown with another roll rate";
    case Cause::kFeatures:
      if (features_parameter(estimator_of(document)).empty()) {
        return "the estimator has no known parameter for the number of features";
      }
      if (features_of(estimator_of(document)) < kMostFeatures) return std::nullopt;
      return "the estimator uses as many features as it can";
    case Cause::kStart:
      return std::nullopt;
    default:
      if (is_present(document, cause)) return std::nullopt;
      return "the flight has none";
  }
}

bool can_scale(const Json& document, Cause cause) {
  const Json* sensor = sensor_of(document);
  switch (cause) {
    case Cause::kFaults:
      return scales_faults(document, cause);
    case Cause::kDrops:
      return document.value("pacing", "") != "real_time" &&
             number(estimator_of(document), "throttle_hz") == 0.0;
    case Cause::kBlur:
      return sensor != nullptr && !sensor->contains("auto_exposure");
    case Cause::kNoise:
      return sensor != nullptr && !sensor->contains("auto_exposure") &&
             !any_positive(*sensor, {"gain_dn_per_e", "full_well_e", "adc_bits"});
    case Cause::kTurbulence:
      return !has_gusts(document);
    case Cause::kRollingShutter:
    case Cause::kRollRate:
      return true;
    default:
      return false;
  }
}

void change(Json& document, const CauseChange& change) {
  const double share = change.share;
  Json& camera = camera_of(document);
  switch (change.cause) {
    case Cause::kFaults:
      return change_faults(document, change.cause, share);
    case Cause::kDrops:
      return change_drops(document, share);
    case Cause::kCalibration:
      camera["calibrated"] = false;
      return;
    case Cause::kBlur:
      return change_blur(camera["sensor"], share);
    case Cause::kRollingShutter:
      return scale(camera["sensor"], "readout_ms", share);
    case Cause::kExposure:
      return change_exposure(camera["sensor"]);
    case Cause::kNoise:
      return change_noise(camera["sensor"], share);
    case Cause::kTurbulence:
      return change_turbulence(document, share);
    case Cause::kTexture:
      document["detail"] = Json::object();
      return;
    case Cause::kRollRate:
      return scale(document["flight"]["course"], "roll_rate_max_deg_s", share);
    case Cause::kFeatures:
      return change_features(estimator_of(document));
    case Cause::kStart:
      document["start_s"] = document.value("start_s", 0.0) + kStartShift_s;
      return;
  }
}

double suspicion(const Json& document, Cause cause, double instant_s) {
  constexpr double kBefore_s = 4.0;
  if (cause == Cause::kFaults || cause == Cause::kDrops) {
    for (const Json& fault : document.value("faults", Json::array())) {
      if (!concerns(document, fault, cause)) continue;
      const double from_s = fault.at("at_s").get<double>();
      const double to_s = from_s + fault.value("duration_s", 86400.0);
      if (from_s <= instant_s && to_s >= instant_s - kBefore_s) return 1.0;
    }
    return any_fault(document, cause) ? 0.2 : 0.6;
  }
  constexpr std::array kOrder = {Cause::kBlur,
                                 Cause::kCalibration,
                                 Cause::kExposure,
                                 Cause::kRollingShutter,
                                 Cause::kNoise,
                                 Cause::kTurbulence};
  const auto* place = std::find(kOrder.begin(), kOrder.end(), cause);
  return 0.5 - 0.05 * static_cast<double>(place - kOrder.begin());
}

}  // namespace overfly::server::experiments
