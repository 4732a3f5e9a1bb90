// The one ROS node that a process can be.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "vo_bridges/ros1/own_topics.hpp"
#include "vo_bridges/ros1/ros1_log.hpp"
#include "vo_bridges/ros1/ros1_master.hpp"

namespace overfly::ros1 {

/// ROS knows one node, with one master, in the life of a process: it begins with the first
/// estimator and stays. All methods may be called from any thread.
class Node {
 public:
  /// Begins the node, or finds it. ROS installs no handler of SIGINT; its logging goes to the logs
  /// of the estimators instead of stdout and stderr.
  /// @param patience  for the master to answer
  /// @param cancel    as Ros1EstimatorOptions has it
  /// Errors: kCancelled; kNotFound when the master does not answer in time; kConflict when this
  /// process is the node of another master, or the master has a living node of that name;
  /// kInternal.
  [[nodiscard]] static Result<Node*> join(const XmlRpcAddress& master,
                                          const std::string& name,
                                          std::chrono::nanoseconds patience,
                                          const std::atomic<bool>* cancel = nullptr);
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  [[nodiscard]] const XmlRpcAddress& master() const { return master_; }
  /// With its slash ("/overfly").
  [[nodiscard]] const std::string& name() const { return name_; }
  /// False when it was told to end ("rosnode kill").
  [[nodiscard]] static bool alive();

  /// Takes topics for one estimator: all or none. Errors: kConflict naming option and topic.
  [[nodiscard]] Status claim(const std::vector<OwnTopic>& topics);
  void release(const std::vector<OwnTopic>& topics);

  /// What roscpp logs goes to these.
  void add_log(const std::shared_ptr<LineLog>& log);
  void say(const std::string& line);

 private:
  Node(XmlRpcAddress master, std::string name);
  static Status start(const XmlRpcAddress& master, const std::string& name);

  XmlRpcAddress master_;
  std::string name_;
  std::mutex mutex_;
  std::set<std::string> claimed_;
  std::vector<std::weak_ptr<LineLog>> logs_;
};

}  // namespace overfly::ros1
