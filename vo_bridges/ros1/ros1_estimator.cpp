#include "vo_bridges/ros1/ros1_estimator.hpp"

#include <utility>

#include "vo_bridges/ros1/ros1_option_check.hpp"
#include "vo_bridges/ros1/ros1_parameters.hpp"
#include "vo_bridges/ros1/ros1_session.hpp"

namespace overfly {

Result<std::unique_ptr<VoPort>> create_ros1_estimator(const Ros1EstimatorOptions& options) {
  using Clock = ros1::AnswerPatience::Clock;
  const auto master = ros1::check(options);
  if (!master) return master.error();
  const auto patience = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(options.start_timeout_s));
  const Clock::time_point end = Clock::now() + patience;
  const auto node = ros1::Node::join(*master, options.node_name, patience, options.cancel);
  if (!node) return node.error();
  if (Status status = ros1::write_parameters(options.parameter_namespace, options.parameters);
      !status) {
    return status.error();
  }
  auto session = std::make_unique<ros1::Session>(**node, options);
  if (Status status = session->begin(end); !status) return status.error();
  return std::unique_ptr<VoPort>(std::move(session));
}

}  // namespace overfly
