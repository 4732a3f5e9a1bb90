// The parameters of the feature estimator and their limits.
#include "odometry/feature/feature_odometry.hpp"
#include "odometry/shell/parameter_table.hpp"

namespace overfly::odometry::feature {
namespace {

using Table = ParameterTable<FeatureParameters>;

const Table& table() {
  static const Table fields{
      .estimator = "feature",
      .wholes = {{"features", 100, 20000, &FeatureParameters::features},
                 {"levels", 1, 16, &FeatureParameters::levels},
                 {"ini_fast_threshold", 1, 100, &FeatureParameters::ini_fast_threshold},
                 {"min_fast_threshold", 1, 100, &FeatureParameters::min_fast_threshold},
                 {"threads", 1, 2, &FeatureParameters::threads}},
      .switches = {{"rotation_compensation", &FeatureParameters::rotation_compensation},
                   {"planar_start", &FeatureParameters::planar_start},
                   {"low_texture", &FeatureParameters::low_texture},
                   {"reject_saturated", &FeatureParameters::reject_saturated}},
      .numbers = {{"initial_height_m",
                   [](double height_m) { return height_m >= 0.0 && height_m <= 20000.0; },
                   "in [0, 20000], 0 = not known",
                   &FeatureParameters::initial_height_m},
                  {"scale_factor",
                   [](double factor) { return factor > 1.0 && factor <= 2.0; },
                   "in (1, 2]",
                   &FeatureParameters::scale_factor}},
      .seeds = {{"seed", &FeatureParameters::seed}}};
  return fields;
}

}  // namespace

std::map<std::string, double> values_of(const FeatureParameters& parameters) {
  return table().values_of(parameters);
}

std::map<std::string, std::string> texts_of(const FeatureParameters& parameters) {
  return table().texts_of(parameters);
}

Result<FeatureParameters> feature_parameters_from(const std::map<std::string, double>& values) {
  Result<FeatureParameters> read = table().read(values);
  if (!read || read->min_fast_threshold <= read->ini_fast_threshold) return read;
  // The default minimum gives way to a lower initial threshold; a stated one is an error.
  if (!values.contains("min_fast_threshold")) {
    read->min_fast_threshold = read->ini_fast_threshold;
    return read;
  }
  return parameter_error(
      "min_fast_threshold",
      read->min_fast_threshold,
      "at most ini_fast_threshold = " + std::to_string(read->ini_fast_threshold));
}

}  // namespace overfly::odometry::feature
