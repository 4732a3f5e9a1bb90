#include "middleware/ros1/master_watch.hpp"

#include <ros/xmlrpc_manager.h>

#include <utility>

namespace overfly::ros1 {
namespace {

using namespace std::chrono_literals;

}  // namespace

MasterWatch::MasterWatch(XmlRpcAddress master,
                         std::string node_name,
                         std::vector<TopicRegistration> topics,
                         std::shared_ptr<LineLog> log,
                         std::function<void(const std::atomic<bool>& cancel)> each_second)
    : master_(std::move(master)),
      node_name_(std::move(node_name)),
      topics_(std::move(topics)),
      log_(std::move(log)),
      each_second_(std::move(each_second)),
      thread_([this] { run(); }) {}

MasterWatch::~MasterWatch() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  ended_.notify_all();
  thread_.join();
}

void MasterWatch::run() {
  std::unique_lock lock(mutex_);
  do {
    lock.unlock();
    look();
    lock.lock();
  } while (!ended_.wait_for(lock, 1s, [this] { return end_.load(); }));
}

void MasterWatch::look() {
  const Result<int> pid = ask_pid(master_, 1s, &end_);
  if (end_) return;
  if (!pid) {
    if (answers_.exchange(false)) {
      log_->add("the ROS master at " + master_.uri() +
                " no longer answers: connected topics keep working, new nodes cannot join");
    }
    return;
  }
  const bool was_away = !answers_.exchange(true);
  const std::optional<int> before = std::exchange(pid_, *pid);
  if (before && *before != *pid) {
    register_again();
  } else if (was_away) {
    log_->add("the ROS master at " + master_.uri() + " answers again");
  }
  each_second_(end_);
}

void MasterWatch::register_again() {
  const std::string own_uri = ros::XMLRPCManager::instance()->getServerURI();
  const auto own = parse_xml_rpc_address(own_uri);
  for (const TopicRegistration& topic : topics_) {
    const std::string method = topic.published ? "registerPublisher" : "registerSubscriber";
    Result<XmlRpc::XmlRpcValue> publishers =
        call_xml_rpc(master_, method, {node_name_, topic.topic, topic.type, own_uri}, 1s);
    if (!publishers) {
      log_->add(publishers.error().message);
      continue;
    }
    if (topic.published || !own) continue;
    // The new master has not yet reported publishers that may already be connected.
    const bool known =
        publishers->getType() == XmlRpc::XmlRpcValue::TypeArray && publishers->size() > 0;
    if (!known) continue;
    // Report them as a master does: roscpp then connects to the publishers that are new to it.
    const Status told = tell_publishers(*own, topic.topic, *publishers, 1s);
    if (!told) log_->add(told.error().message);
  }
  log_->add("the ROS master at " + master_.uri() +
            " was restarted; the topics are registered again");
}

}  // namespace overfly::ros1
