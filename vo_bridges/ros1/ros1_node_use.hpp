// What the process of an estimator's node uses, where it runs on this machine.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>

#include "vo_bridges/ros1/ros1_master.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::ros1 {

/// The estimator's node is the one that takes the images and publishes the poses, as the master
/// knows them. Its process is asked for by getPid, which tells the truth where nodes and this
/// process share their process ids (not from one container to another). May be used from any
/// thread.
class NodeUse {
 public:
  NodeUse(XmlRpcAddress master,
          std::string own_name,
          std::string image_topic,
          std::string pose_topic);

  /// Looks for the process, unless it is known and runs.
  /// @param timeout  for each of three calls
  void look(std::chrono::nanoseconds timeout, const std::atomic<bool>* cancel);
  /// CPU since the process was found; of a node that came back, of all its processes. Empty where
  /// none was found here.
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
  ResourceUse earlier_;        ///< of the processes before this one
  mutable ResourceUse last_;   ///< of this process, as long as it ran
};

}  // namespace overfly::ros1
