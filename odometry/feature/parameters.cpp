#include <array>
#include <cmath>
#include <functional>
#include <sstream>

#include "odometry/feature/feature_odometry.hpp"
#include "vo_bridges/parameter.hpp"

namespace overfly::odometry {
namespace {

Error bad(const std::string& field, double value, const std::string& limit) {
  std::ostringstream text;
  text << "parameters." << field << " = " << value << ": must be " << limit;
  return {ErrorCode::kInvalidArgument, text.str()};
}

bool whole(double value) { return std::isfinite(value) && value == std::floor(value); }

struct WholeField {
  const char* name;
  int low;
  int high;
  int FeatureParameters::*field;
};

constexpr std::array<WholeField, 5> kWholeFields{{
    {"features", 100, 20000, &FeatureParameters::features},
    {"levels", 1, 16, &FeatureParameters::levels},
    {"ini_fast_threshold", 1, 100, &FeatureParameters::ini_fast_threshold},
    {"min_fast_threshold", 1, 100, &FeatureParameters::min_fast_threshold},
    {"threads", 1, 2, &FeatureParameters::threads},
}};

struct Switch {
  const char* name;
  bool FeatureParameters::*field;
};

constexpr std::array<Switch, 4> kSwitches{{
    {"rotation_compensation", &FeatureParameters::rotation_compensation},
    {"planar_start", &FeatureParameters::planar_start},
    {"low_texture", &FeatureParameters::low_texture},
    {"reject_saturated", &FeatureParameters::reject_saturated},
}};

constexpr double kMaxHeightM = 20000.0;

/// Sets one field; returns false for an unknown name.
Result<bool> set_field(const std::string& name, double value, FeatureParameters& parameters) {
  for (const WholeField& field : kWholeFields) {
    if (name != field.name) continue;
    if (!whole(value) || value < field.low || value > field.high) {
      return bad(name,
                 value,
                 "a whole number in [" + std::to_string(field.low) + ", " +
                     std::to_string(field.high) + "]");
    }
    parameters.*field.field = static_cast<int>(value);
    return true;
  }
  for (const Switch& option : kSwitches) {
    if (name != option.name) continue;
    if (value != 0.0 && value != 1.0) return bad(name, value, "true or false (1 or 0)");
    parameters.*option.field = value != 0.0;
    return true;
  }
  if (name == "initial_height_m") {
    if (!(value >= 0.0 && value <= kMaxHeightM)) {
      return bad(name, value, "in [0, 20000], 0 = unknown");
    }
    parameters.initial_height_m = value;
    return true;
  }
  if (name == "scale_factor") {
    if (!(value > 1.0 && value <= 2.0)) return bad(name, value, "in (1, 2]");
    parameters.scale_factor = value;
    return true;
  }
  if (name == "seed") {
    // Above 2^53 a JSON number cannot represent every integer.
    if (!whole(value) || value < 0.0 || value > 9007199254740992.0) {
      return bad(name, value, "a whole number in [0, 2^53]");
    }
    parameters.seed = static_cast<std::uint64_t>(value);
    return true;
  }
  return false;
}

std::string known_names() {
  std::string names;
  for (const auto& [name, value] : values_of(FeatureParameters{})) {
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

}  // namespace

std::map<std::string, double> values_of(const FeatureParameters& parameters) {
  std::map<std::string, double> values{{"scale_factor", parameters.scale_factor},
                                       {"seed", static_cast<double>(parameters.seed)},
                                       {"initial_height_m", parameters.initial_height_m}};
  for (const WholeField& field : kWholeFields) values[field.name] = parameters.*field.field;
  for (const Switch& option : kSwitches) values[option.name] = parameters.*option.field ? 1.0 : 0.0;
  return values;
}

std::map<std::string, std::string> texts_of(const FeatureParameters& parameters) {
  std::map<std::string, std::string> texts;
  for (const auto& [name, value] : values_of(parameters)) texts[name] = text_of(value);
  for (const Switch& option : kSwitches) texts[option.name] = text_of(parameters.*option.field);
  return texts;
}

Result<FeatureParameters> feature_parameters_from(const std::map<std::string, double>& values) {
  FeatureParameters parameters;
  for (const auto& [name, value] : values) {
    const Result<bool> known = set_field(name, value, parameters);
    if (!known) return known.error();
    if (!known.value()) {
      return Error{ErrorCode::kInvalidArgument,
                   "parameters." + name + ": not a parameter of the feature estimator (" +
                       known_names() + ")"};
    }
  }
  if (parameters.min_fast_threshold > parameters.ini_fast_threshold) {
    // A default minimum is lowered to the initial threshold; an explicit one above it is an error.
    if (!values.contains("min_fast_threshold")) {
      parameters.min_fast_threshold = parameters.ini_fast_threshold;
      return parameters;
    }
    return bad("min_fast_threshold",
               parameters.min_fast_threshold,
               "at most ini_fast_threshold = " + std::to_string(parameters.ini_fast_threshold));
  }
  return parameters;
}

}  // namespace overfly::odometry
