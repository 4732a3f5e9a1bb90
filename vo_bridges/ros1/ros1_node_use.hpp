// Resource use of the process of an estimator's node, if it runs on this machine.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>

#include "middleware/ros1/master.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::ros1 {

/// The estimator's node is the one that subscribes to the images and publishes the poses according
/// to the master. Its process id comes from getPid, which is valid only if the node and this
/// process share a process namespace (not across containers). Thread-safe.
class NodeUse {
 public:
  NodeUse(XmlRpcAddress master,
          std::string own_name,
          std::string image_topic,
          std::string pose_topic);

  /// Searches the process unless it is known and running.
  /// @param timeout  for each of three calls
  void look(std::chrono::nanoseconds timeout, const std::atomic<bool>* cancel);
  /// CPU time since the process was found; for a restarted node the total of its processes. Empty
  /// if none was found.
  [[nodiscard]] std::optional<ResourceUse> use() const;

 private:
  [[nodiscard]] std::optional<int> find(std::chrono::nanoseconds timeout,
                                        const std::atomic<bool>* cancel) const;

  const XmlRpcAddress master_;
  const std::string own_name_;
  const std::string image_topic_;
  const std::string pose_topic_;
  mutable std::mutex mutex_;
  std::optional<int> pid_;
  double cpu_before_s_ = 0.0;  ///< of this process, when it was found
  ResourceUse earlier_;        ///< of the previous processes
  mutable ResourceUse last_;   ///< of this process, while it was running
};

}  // namespace overfly::ros1
