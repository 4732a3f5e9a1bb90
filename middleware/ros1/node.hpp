// The ROS node of this process.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "middleware/ros1/line_log.hpp"
#include "middleware/ros1/master.hpp"
#include "middleware/ros1/own_topic.hpp"

namespace overfly::ros1 {

/// ROS allows one node, with one master, per process. The first call of join creates it, and it
/// stays. Thread-safe.
class Node {
 public:
  /// Creates the node, or returns the existing one. ROS installs no SIGINT handler; its log
  /// messages go to the added logs instead of stdout and stderr.
  /// @param patience  time limit for the master's answer
  /// @param cancel    may be null; set to true to end the wait within 50 ms
  /// Errors: kCancelled; kNotFound if the master does not answer in time; kConflict if this process
  /// is a node of another master, or if the master has a living node of that name; kInternal if the
  /// node was shut down, or with the reason if ROS cannot be started.
  [[nodiscard]] static Result<Node*> join(const XmlRpcAddress& master,
                                          const std::string& name,
                                          std::chrono::nanoseconds patience,
                                          const std::atomic<bool>* cancel = nullptr);
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  [[nodiscard]] const XmlRpcAddress& master() const { return master_; }
  /// With leading slash ("/overfly").
  [[nodiscard]] const std::string& name() const { return name_; }
  /// False if the node was told to shut down ("rosnode kill").
  [[nodiscard]] static bool alive();

  /// Reserves topics for one user of the node: all or none.
  /// @return the first topic that is reserved already; empty on success
  [[nodiscard]] std::optional<OwnTopic> claim(const std::vector<OwnTopic>& topics);
  void release(const std::vector<OwnTopic>& topics);

  /// Adds a destination for roscpp's log messages.
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
