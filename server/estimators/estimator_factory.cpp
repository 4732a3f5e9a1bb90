#include "server/estimators/estimator_factory.hpp"

#include <map>
#include <utility>

#include "odometry/baseline/baseline_odometry.hpp"
#include "odometry/feature/feature_odometry.hpp"
#include "server/estimators/estimator_doors.hpp"
#include "vo_bridges/toy/toy_estimators.hpp"

namespace overfly::server {
namespace {

using Port = Result<std::unique_ptr<VoPort>>;

/// Switches become 1 and 0. Errors: kInvalidArgument for text.
Result<std::map<std::string, double>> numbers_of(const VoParameters& parameters) {
  std::map<std::string, double> numbers;
  for (const auto& [name, value] : parameters) {
    if (const double* number = std::get_if<double>(&value)) {
      numbers[name] = *number;
    } else if (const bool* flag = std::get_if<bool>(&value)) {
      numbers[name] = *flag ? 1.0 : 0.0;
    } else {
      return Error{ErrorCode::kInvalidArgument,
                   "parameters." + name + " = \"" + text_of(value) + "\": must be a number"};
    }
  }
  return numbers;
}

Result<odometry::feature::FeatureParameters> feature_parameters_of(
    const EstimatorSpec& spec, const EstimatorSetting& setting) {
  auto values = numbers_of(spec.parameters);
  if (!values) return values.error();
  values->try_emplace("seed", static_cast<double>(setting.seed));
  values->try_emplace("threads", setting.lockstep ? 1.0 : 2.0);
  return odometry::feature::feature_parameters_from(*values);
}

Port create_feature(const EstimatorSpec& spec, const EstimatorSetting& setting) {
  const auto parameters = feature_parameters_of(spec, setting);
  if (!parameters) return parameters.error();
  return odometry::feature::create_feature_odometry(*parameters);
}

Result<ToyParameters> toy_parameters_of(const EstimatorSpec& spec) {
  const auto values = numbers_of(spec.parameters);
  if (!values) return values.error();
  ToyParameters parameters;
  for (const auto& [key, value] : *values) {
    if (key == "scale") {
      parameters.scale = value;
    } else if (key == "drift") {
      parameters.drift = value;
    } else if (key == "scene_depth_m") {
      parameters.scene_depth_m = value;
    } else {
      return Error{ErrorCode::kInvalidArgument,
                   "parameters." + key + ": must be drift, scale or scene_depth_m"};
    }
  }
  if (spec.type == "perfect") parameters.drift = 0.0;  // whatever is given
  if (Status status = check_toy_parameters(parameters); !status) return status.error();
  return parameters;
}

Port create_toy(const EstimatorSpec& spec, const ToyTruthAt& truth) {
  if (!truth) {
    return Error{ErrorCode::kInvalidArgument,
                 spec.type + ": needs the truth, which is not available"};
  }
  const Result<ToyParameters> parameters = toy_parameters_of(spec);
  if (!parameters) return parameters.error();
  return spec.type == "perfect" ? create_perfect_estimator(truth, *parameters)
                                : create_drifting_estimator(truth, *parameters);
}

Result<odometry::baseline::HomographyParameters> homography_parameters_of(
    const EstimatorSpec& spec) {
  const auto values = numbers_of(spec.parameters);
  if (!values) return values.error();
  return odometry::baseline::homography_parameters_from(*values);
}

/// Of a baseline that has no parameters.
Status check_no_parameters(const EstimatorSpec& spec) {
  if (spec.parameters.empty()) return {};
  return Error{ErrorCode::kInvalidArgument,
               "parameters." + spec.parameters.begin()->first + ": must be left out: " + spec.type +
                   " has no parameters"};
}

Port create_baseline(const EstimatorSpec& spec, const EstimatorSetting& setting) {
  if (spec.type == "baseline_homography") {
    const auto parameters = homography_parameters_of(spec);
    if (!parameters) return parameters.error();
    return odometry::baseline::create_homography(*parameters);
  }
  if (Status status = check_no_parameters(spec); !status) return status.error();
  if (spec.type == "baseline_hold") return odometry::baseline::create_hold();
  return odometry::baseline::create_dead_reckoning(setting.T_body_camera);
}

Status check_parameters(const EstimatorSpec& spec) {
  const auto status_of = [](const auto& result) { return result ? Status{} : result.error(); };
  if (spec.type == "feature") return status_of(feature_parameters_of(spec, {}));
  if (spec.type == "baseline_homography") return status_of(homography_parameters_of(spec));
  if (is_baseline_estimator(spec.type)) return check_no_parameters(spec);
  if (is_test_estimator(spec.type)) return status_of(toy_parameters_of(spec));
  return {};
}

Port create(const EstimatorSpec& spec, const EstimatorSetting& setting, const ToyTruthAt& truth) {
  if (spec.type == "feature") return create_feature(spec, setting);
  if (is_baseline_estimator(spec.type)) return create_baseline(spec, setting);
  if (is_test_estimator(spec.type)) return create_toy(spec, truth);
  if (is_outside_estimator(spec.type)) return create_outside_estimator(spec, setting);
  return Error{ErrorCode::kInvalidArgument,
               "type = \"" + spec.type +
                   "\": must be one of feature, baseline_hold, baseline_homography, "
                   "baseline_dead_reckoning, perfect, drifting, process, lcm, ros1"};
}

}  // namespace

Result<std::unique_ptr<VoPort>> create_estimator(const EstimatorSpec& spec,
                                                 const EstimatorSetting& setting,
                                                 const ToyTruthAt& truth) {
  Port port = create(spec, setting, truth);
  if (!port) return port.error().in("estimator \"" + spec.name + "\"");
  return port;
}

Status check_native_parameters(const std::vector<EstimatorSpec>& specs) {
  std::string messages;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const Status status = check_parameters(specs[i]);
    if (status) continue;
    messages += (messages.empty() ? "" : "\n") + ("estimators." + std::to_string(i)) + "." +
                status.error().message;
  }
  if (messages.empty()) return {};
  return Error{ErrorCode::kInvalidArgument, messages};
}

double own_bytes_per_px(const EstimatorSpec& spec) {
  if (spec.type == "baseline_homography") return odometry::baseline::kHomographyBytesPerPx;
  if (spec.type != "feature") return 0.0;
  // One with parameters that are not valid does not fly.
  const auto parameters = feature_parameters_of(spec, {});
  return parameters ? odometry::feature::most_bytes_per_px(*parameters) : 0.0;
}

}  // namespace overfly::server
