#include "tests/vo_bridges/ros1/ros_world.hpp"

#include <fcntl.h>
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "core/time.hpp"
#include "middleware/ros1/master.hpp"
#include "vo_bridges/ros1/ros1_option_check.hpp"

namespace overfly::testing {
namespace {

using namespace std::chrono_literals;

/// A port that is free now.
int free_port() {
  const int handle = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  if (bind(handle, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      getsockname(handle, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    throw std::runtime_error("no free port");
  }
  close(handle);
  return ntohs(address.sin_port);
}

}  // namespace

Child::Child(const std::vector<std::string>& command, const std::filesystem::path& output) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& argument : command) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  pid_ = fork();
  if (pid_ != 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  dup2(file, STDOUT_FILENO);
  dup2(file, STDERR_FILENO);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

Child::~Child() { kill(); }

void Child::kill() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

bool has_rosmaster() {
  const char* const path = std::getenv("PATH");
  std::stringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (access((folder + "/rosmaster").c_str(), X_OK) == 0) return true;
  }
  return false;
}

bool wait_for(const std::function<bool()>& done, double most_s) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(most_s);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(10ms);
  }
  return true;
}

bool logs(VoPort& port, const std::string& text) {
  std::string all;
  return wait_for([&] {
    for (const std::string& line : port.take_log()) all += line + "\n";
    return all.find(text) != std::string::npos;
  });
}

RosMaster::RosMaster() : port_(free_port()), uri_("http://127.0.0.1:" + std::to_string(port_)) {
  setenv("ROS_IP", "127.0.0.1", 1);
  setenv("ROS_LOG_DIR", folder_.path().c_str(), 1);
}

RosMaster& RosMaster::instance() {
  static RosMaster master;
  return master;
}

void RosMaster::start() {
  if (process_) return;
  process_ = std::make_unique<Child>(
      std::vector<std::string>{"rosmaster", "--core", "-p", std::to_string(port_)},
      folder_.path() / "rosmaster.log");
  const auto address = ros1::parse_xml_rpc_address(uri_).value();
  const bool up = wait_for([&] { return ros1::ask_pid(address, 1s).ok(); });
  if (!up) throw std::runtime_error("rosmaster: " + read_text(folder_.path() / "rosmaster.log"));
}

void RosMaster::stop() { process_.reset(); }

Ros1EstimatorOptions fresh_options() {
  static int count = 0;
  const std::string prefix = "/vo" + std::to_string(count++);
  Ros1EstimatorOptions options;
  options.master_uri = RosMaster::instance().uri();
  options.node_name = "overfly_test";
  options.image_topic = prefix + "/image_raw";
  options.camera_info_topic = prefix + "/camera_info";
  options.pose_topic = prefix + "/pose";
  options.debug_image_topic = prefix + "/debug";
  options.start_timeout_s = 20.0;
  return options;
}

std::unique_ptr<VoPort> created(const Ros1EstimatorOptions& options) {
  auto port = create_ros1_estimator(options);
  if (!port) throw std::runtime_error(port.error().message);
  return std::move(port).value();
}

std::vector<VoFrame> grey_frames(int count) {
  std::vector<VoFrame> frames(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    Image image(64, 48, 1);
    for (std::size_t k = 0; k < image.data.size(); ++k) {
      image.data[k] = static_cast<std::uint8_t>(k * 7 + static_cast<std::size_t>(i) * 5);
    }
    VoFrame& frame = frames[static_cast<std::size_t>(i)];
    frame.index = i;
    frame.t_ns = frame_time_ns(i, FrameRate{});
    frame.image = std::make_shared<const Image>(std::move(image));
    frame.intrinsics = PinholeCamera::from_fov(64, 48, 1.48, FovAxis::kHorizontal).value();
  }
  return frames;
}

TestNode::TestNode(const Ros1EstimatorOptions& options, const std::vector<std::string>& arguments) {
  std::string name = "node" + options.image_topic;
  for (char& c : name) c = c == '/' ? '_' : c;
  std::vector<std::string> command = {ROS1_TEST_NODE,
                                      "__master:=" + options.master_uri,
                                      "__name:=" + name,
                                      "image=" + options.image_topic,
                                      "info=" + options.camera_info_topic,
                                      "pose=" + options.pose_topic,
                                      "debug=" + options.debug_image_topic,
                                      "parent=" + options.vo_frame,
                                      "child=" + options.camera_frame,
                                      std::string("type=") + ros1::to_string(options.pose_type)};
  command.insert(command.end(), arguments.begin(), arguments.end());
  process_ = std::make_unique<Child>(command, folder_.path() / "output");
}

std::string TestNode::output() const {
  return std::filesystem::exists(folder_.path() / "output") ? read_text(folder_.path() / "output")
                                                            : "";
}

bool TestNode::says(const std::string& text) const {
  return wait_for([&] { return output().find(text) != std::string::npos; });
}

}  // namespace overfly::testing
