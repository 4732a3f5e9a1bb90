// A ROS master and an estimator's node for tests: child processes, ended with their objects.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/support.hpp"
#include "vo_bridges/ros1/ros1_estimator.hpp"

namespace overfly::testing {

/// A program that ends with its object, and with ours.
class Child {
 public:
  Child(const std::vector<std::string>& command, const std::filesystem::path& output);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  /// At once, as by a crash.
  void kill();
  [[nodiscard]] int pid() const { return pid_; }

 private:
  pid_t pid_ = -1;
};

/// True where the tests can start a master.
[[nodiscard]] bool has_rosmaster();

/// The master of this program: always on one port, since ROS knows one master a process.
class RosMaster {
 public:
  static RosMaster& instance();
  [[nodiscard]] const std::string& uri() const { return uri_; }
  /// Until it answers; does nothing while it runs.
  void start();
  void stop();

 private:
  RosMaster();
  TemporaryFolder folder_;
  int port_;
  std::string uri_;
  std::unique_ptr<Child> process_;
};

/// Topics of their own for each estimator: "/vo3/image_raw".
[[nodiscard]] Ros1EstimatorOptions fresh_options();

/// The estimator of tests/vo_bridges/ros1/ros1_test_node.cpp.
class TestNode {
 public:
  /// @param arguments  beyond topics and pose type, which are the options'
  explicit TestNode(const Ros1EstimatorOptions& options,
                    const std::vector<std::string>& arguments = {});
  void kill() { process_->kill(); }
  [[nodiscard]] int pid() const { return process_->pid(); }
  /// What it printed; waits for a line to be there.
  [[nodiscard]] std::string output() const;
  [[nodiscard]] bool says(const std::string& text) const;

 private:
  TemporaryFolder folder_;
  std::unique_ptr<Child> process_;
};

/// Small grey frames at 31 Hz, no two alike.
[[nodiscard]] std::vector<VoFrame> grey_frames(int count);

/// An estimator of these options. @throws std::runtime_error when it is refused
[[nodiscard]] std::unique_ptr<VoPort> created(const Ros1EstimatorOptions& options);

/// Waits until `done`, at most that long. @return whether it is
[[nodiscard]] bool wait_for(const std::function<bool()>& done, double most_s = 20.0);

/// Waits for the log of an estimator to hold a text.
[[nodiscard]] bool logs(VoPort& port, const std::string& text);

}  // namespace overfly::testing

/// Starts the master, or skips the test with the reason.
#define ROS_MASTER_OR_SKIP()                                                         \
  if (!::overfly::testing::has_rosmaster()) {                                        \
    GTEST_SKIP() << "rosmaster is not installed (Debian package python3-rosmaster)"; \
  }                                                                                  \
  ::overfly::testing::RosMaster::instance().start()
