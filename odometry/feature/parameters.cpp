#include <array>
#include <cmath>
#include <functional>
#include <sstream>

#include "odometry/feature/feature_odometry.hpp"

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

constexpr std::array<WholeField, 4> kWholeFields{{
    {"features", 100, 20000, &FeatureParameters::features},
    {"levels", 1, 16, &FeatureParameters::levels},
    {"ini_fast_threshold", 1, 100, &FeatureParameters::ini_fast_threshold},
    {"min_fast_threshold", 1, 100, &FeatureParameters::min_fast_threshold},
}};

/// Sets one field; false for a name that is not known.
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
  if (name == "scale_factor") {
    if (!(value > 1.0 && value <= 2.0)) return bad(name, value, "in (1, 2]");
    parameters.scale_factor = value;
    return true;
  }
  if (name == "seed") {
    // Above 2^53 a JSON number no longer tells neighbours apart.
    if (!whole(value) || value < 0.0 || value > 9007199254740992.0) {
      return bad(name, value, "a whole number in [0, 2^53]");
    }
    parameters.seed = static_cast<std::uint64_t>(value);
    return true;
  }
  return false;
}

}  // namespace

Result<FeatureParameters> feature_parameters_from(const std::map<std::string, double>& values) {
  FeatureParameters parameters;
  for (const auto& [name, value] : values) {
    const Result<bool> known = set_field(name, value, parameters);
    if (!known) return known.error();
    if (!known.value()) {
      return Error{ErrorCode::kInvalidArgument,
                   "parameters." + name +
                       ": not a parameter of the feature estimator (features, scale_factor, "
                       "levels, ini_fast_threshold, min_fast_threshold, seed)"};
    }
  }
  if (parameters.min_fast_threshold > parameters.ini_fast_threshold) {
    // The default minimum gives way to a lower initial threshold; a stated one is an error.
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
