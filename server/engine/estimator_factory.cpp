#include "server/engine/estimator_factory.hpp"

#include <utility>

#include "odometry/feature/feature_odometry.hpp"
#include "vo_bridges/toy/toy_estimators.hpp"

namespace overfly::engine {
namespace {

Result<std::unique_ptr<VoPort>> create_feature(const EstimatorSpec& spec, std::uint64_t seed) {
  std::map<std::string, double> values = spec.parameters;
  values.try_emplace("seed", static_cast<double>(seed));
  const auto parameters = odometry::feature_parameters_from(values);
  if (!parameters) return parameters.error();
  return odometry::create_feature_odometry(*parameters);
}

Result<ToyParameters> toy_parameters_from(const std::map<std::string, double>& values,
                                          double scene_depth_m) {
  ToyParameters parameters;
  parameters.scene_depth_m = scene_depth_m;
  for (const auto& [key, value] : values) {
    if (key == "scale") {
      parameters.scale = value;
    } else if (key == "drift") {
      parameters.drift = value;
    } else if (key == "scene_depth_m") {
      parameters.scene_depth_m = value;
    } else {
      return Error{ErrorCode::kInvalidArgument,
                   key + ": no such parameter (known: drift, scale, scene_depth_m)"};
    }
  }
  return parameters;
}

Result<std::unique_ptr<VoPort>> create_toy(const EstimatorSpec& spec,
                                           const std::function<Result<ToyTruth>()>& truth) {
  const Result<ToyTruth> known = truth();
  if (!known) return known.error();
  const Result<ToyParameters> parameters =
      toy_parameters_from(spec.parameters, known->scene_depth_m);
  if (!parameters) return parameters.error();
  return spec.type == "perfect" ? create_perfect_estimator(known->T_world_camera, *parameters)
                                : create_drifting_estimator(known->T_world_camera, *parameters);
}

}  // namespace

Result<std::unique_ptr<VoPort>> create_estimator(const EstimatorSpec& spec,
                                                 std::uint64_t seed,
                                                 const std::function<Result<ToyTruth>()>& truth) {
  Result<std::unique_ptr<VoPort>> port =
      spec.type == "feature" ? create_feature(spec, seed) : create_toy(spec, truth);
  if (!port) return port.error().in("estimator \"" + spec.name + "\"");
  return port;
}

}  // namespace overfly::engine
