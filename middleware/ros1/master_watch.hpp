// Monitors the master while topics are in use. roscpp does not notice that the master is gone or
// was replaced.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "middleware/ros1/line_log.hpp"
#include "middleware/ros1/master.hpp"

namespace overfly::ros1 {

/// A topic as registered with the master.
struct TopicRegistration {
  std::string topic;
  std::string type;  ///< "sensor_msgs/Image"
  bool published = true;
};

/// Polls the master once a second and calls `each_second` while it answers. Logs when the master
/// goes and returns. Registers the topics again with a restarted master.
class MasterWatch {
 public:
  MasterWatch(XmlRpcAddress master,
              std::string node_name,
              std::vector<TopicRegistration> topics,
              std::shared_ptr<LineLog> log,
              std::function<void(const std::atomic<bool>& cancel)> each_second);
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

  [[nodiscard]] bool master_answers() const { return answers_; }

 private:
  void run();
  void look();
  void register_again();

  const XmlRpcAddress master_;
  const std::string node_name_;
  const std::vector<TopicRegistration> topics_;
  const std::shared_ptr<LineLog> log_;
  const std::function<void(const std::atomic<bool>& cancel)> each_second_;
  std::optional<int> pid_;
  std::atomic<bool> answers_{true};
  std::mutex mutex_;
  std::condition_variable ended_;
  std::atomic<bool> end_{false};
  std::thread thread_;
};

}  // namespace overfly::ros1
