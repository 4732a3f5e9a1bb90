#include "server/estimators/estimator_doors.hpp"

#include "vo_bridges/lcm/lcm_estimator.hpp"
#include "vo_bridges/process/process_estimator.hpp"
#include "vo_bridges/ros1/ros1_estimator.hpp"

namespace overfly::server {
namespace {

using Port = Result<std::unique_ptr<VoPort>>;

Port create_process(const EstimatorSpec& spec, const EstimatorSetting& setting) {
  ProcessEstimatorOptions options;
  options.command = spec.command;
  options.listen = spec.listen;
  options.working_folder = setting.output_folder;
  options.parameters = spec.parameters;
  options.lockstep = setting.lockstep;
  options.rate_hz = setting.rate_hz;
  options.start_timeout_s = spec.start_timeout_s.value_or(options.start_timeout_s);
  options.answer_timeout_s = spec.answer_timeout_s.value_or(options.answer_timeout_s);
  options.cancel = setting.cancel;
  options.cpus = spec.cpus;
  options.memory_limit_mb = spec.memory_limit_mb;
  if (!setting.output_folder.empty()) options.output_file = setting.output_folder / "output.log";
  return create_process_estimator(options);
}

Port create_lcm(const EstimatorSpec& spec, const EstimatorSetting& setting) {
  LcmEstimatorOptions options;
  if (!spec.lcm_url.empty()) options.url = spec.lcm_url;
  if (!spec.lcm_channel_prefix.empty()) options.channel_prefix = spec.lcm_channel_prefix;
  options.parameters = spec.parameters;
  options.lockstep = setting.lockstep;
  options.start_timeout_s = spec.start_timeout_s.value_or(options.start_timeout_s);
  options.answer_timeout_s = spec.answer_timeout_s.value_or(options.answer_timeout_s);
  options.cancel = setting.cancel;
  return create_lcm_estimator(options);
}

Port create_ros1(const EstimatorSpec& spec, const EstimatorSetting& setting) {
  Ros1EstimatorOptions options = spec.ros1;
  options.parameters = spec.parameters;
  options.lockstep = setting.lockstep;
  options.publish_sensors = setting.sensors;
  options.start_timeout_s = spec.start_timeout_s.value_or(options.start_timeout_s);
  options.answer_timeout_s = spec.answer_timeout_s.value_or(options.answer_timeout_s);
  options.cancel = setting.cancel;
  return create_ros1_estimator(options);
}

}  // namespace

Port create_outside_estimator(const EstimatorSpec& spec, const EstimatorSetting& setting) {
  if (spec.type == "process") return create_process(spec, setting);
  if (spec.type == "lcm") return create_lcm(spec, setting);
  return create_ros1(spec, setting);
}

}  // namespace overfly::server
