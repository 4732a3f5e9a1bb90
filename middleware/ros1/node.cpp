#include "middleware/ros1/node.hpp"

#include <ros/console.h>
#include <ros/console_backend.h>
#include <ros/exception.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/this_node.h>

#include <algorithm>
#include <cstdlib>
#include <thread>
#include <utility>

#include "core/cancellable_wait.hpp"

namespace overfly::ros1 {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Never destroyed: roscpp's threads may log after main() has returned.
std::atomic<Node*> the_node = nullptr;
std::timed_mutex joining;
/// Why roscpp stopped in the middle of its start, which it cannot repeat. Guarded by `joining`.
std::optional<Error> broken_start;

void log_line(void* /*logger*/,
              ros::console::Level level,
              const char* text,
              const char* /*file*/,
              const char* /*function*/,
              int /*line*/) {
  Node* const node = the_node;
  if (node != nullptr && level >= ros::console::levels::Warn) {
    node->say(std::string("ROS: ") + text);
  }
}

/// Errors: kNotFound; kCancelled.
Status await_master(const XmlRpcAddress& master,
                    std::chrono::nanoseconds patience,
                    const std::atomic<bool>* cancel) {
  const Clock::time_point end = Clock::now() + patience;
  for (;;) {
    const auto left = std::max<std::chrono::nanoseconds>(end - Clock::now(), 1ms);
    const Result<int> pid = ask_pid(master, std::min<std::chrono::nanoseconds>(left, 2s), cancel);
    if (pid) return {};
    if (is_cancelled(cancel)) return cancelled("the ROS master at " + master.uri());
    if (Clock::now() + 100ms > end) {
      return Error{ErrorCode::kNotFound,
                   "no ROS master answers at " + master.uri() + " within " +
                       std::to_string(std::chrono::duration<double>(patience).count()) +
                       " s: start one with roscore"};
    }
    for (int i = 0; i < 5 && !is_cancelled(cancel); ++i) std::this_thread::sleep_for(20ms);
  }
}

/// The master would shut down the first of two nodes with the same name.
/// Errors: kConflict; kCancelled.
Status check_name_is_free(const XmlRpcAddress& master,
                          const std::string& name,
                          const std::atomic<bool>* cancel) {
  Result<XmlRpc::XmlRpcValue> uri = call_xml_rpc(master, "lookupNode", {name, name}, 2s, cancel);
  if (is_cancelled(cancel)) return cancelled("the ROS master at " + master.uri());
  if (!uri || uri->getType() != XmlRpc::XmlRpcValue::TypeString) return {};
  const auto address = parse_xml_rpc_address(static_cast<std::string>(*uri));
  if (!address || !call_xml_rpc(*address, "getPid", {name}, 2s, cancel)) return {};  // it died
  return Error{ErrorCode::kConflict,
               "node_name = " + name + ": the master at " + master.uri() +
                   " has a node of that name already"};
}

/// Restricts roscpp to the loopback interface; by default it listens on every interface.
void stay_on_loopback() {
  // roscpp reads this only from the environment, in its own threads.
  if (std::getenv("ROS_IP") == nullptr && std::getenv("ROS_HOSTNAME") == nullptr) {
    setenv("ROS_IP", "127.0.0.1", 0);
  }
}

}  // namespace

Node::Node(XmlRpcAddress master, std::string name)
    : master_(std::move(master)), name_(std::move(name)) {}

bool Node::alive() { return ros::ok() && !ros::isShuttingDown(); }

Result<Node*> Node::join(const XmlRpcAddress& master,
                         const std::string& name,
                         std::chrono::nanoseconds patience,
                         const std::atomic<bool>* cancel) {
  std::unique_lock lock(joining, std::defer_lock);
  while (!lock.try_lock_for(kCancelPeriod)) {
    if (is_cancelled(cancel)) return cancelled("the ROS master at " + master.uri());
  }
  if (broken_start) return *broken_start;
  const Node* const before = the_node;
  if (before != nullptr && before->master_ != master) {
    return Error{ErrorCode::kConflict,
                 "master_uri = " + master.uri() + ": this process is a node of the master at " +
                     before->master_.uri() +
                     " already, and ROS allows one node per process: start another overfly"};
  }
  if (Status status = await_master(master, patience, cancel); !status) return status.error();
  if (before == nullptr) {
    if (Status status = check_name_is_free(master, "/" + name, cancel); !status) {
      return status.error();
    }
    if (Status status = start(master, name); !status) return status.error();
  }
  Node* const node = the_node;
  if (!alive()) {
    return Error{ErrorCode::kInternal,
                 "the ROS node " + node->name_ +
                     " of this process was shut down (rosnode kill): restart overfly"};
  }
  return node;
}

Status Node::start(const XmlRpcAddress& master, const std::string& name) {
  ROSCONSOLE_AUTOINIT;
  Node* const node = new Node(master, "/" + name);
  the_node = node;
  ros::console::backend::function_print = log_line;
  std::map<std::string, std::string> settings = {{"__master", master.uri()}};
  if (master.is_loopback()) stay_on_loopback();
  try {
    ros::init(settings, name, ros::init_options::NoSigintHandler | ros::init_options::NoRosout);
    ros::master::setRetryTimeout(ros::WallDuration(5.0));
    ros::start();
    node->name_ = ros::this_node::getName();  // with the namespace of ROS_NAMESPACE
  } catch (const std::exception& failure) {
    // There is no node: the next call has to try again instead of returning this one.
    the_node = nullptr;
    Error error{ErrorCode::kInternal, std::string("ROS cannot be started: ") + failure.what()};
    if (ros::isStarted()) broken_start = error;
    return error;
  }
  return {};
}

std::optional<OwnTopic> Node::claim(const std::vector<OwnTopic>& topics) {
  const std::lock_guard lock(mutex_);
  for (const OwnTopic& topic : topics) {
    if (claimed_.contains(topic.name)) return topic;
  }
  for (const OwnTopic& topic : topics) claimed_.insert(topic.name);
  return std::nullopt;
}

void Node::release(const std::vector<OwnTopic>& topics) {
  const std::lock_guard lock(mutex_);
  for (const OwnTopic& topic : topics) claimed_.erase(topic.name);
}

void Node::add_log(const std::shared_ptr<LineLog>& log) {
  const std::lock_guard lock(mutex_);
  std::erase_if(logs_, [](const std::weak_ptr<LineLog>& known) { return known.expired(); });
  logs_.push_back(log);
}

void Node::say(const std::string& line) {
  const std::lock_guard lock(mutex_);
  for (const std::weak_ptr<LineLog>& known : logs_) {
    if (const std::shared_ptr<LineLog> log = known.lock()) log->add(line);
  }
}

}  // namespace overfly::ros1
