// An estimator for tests: `scripted_estimator BEHAVIOUR [ARGUMENT]` behaves as it is told.
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <array>
#include <chrono>
#include <csignal>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <thread>

#include "vo_bridges/client/overfly_vo.hpp"

namespace {

using overfly_vo::Answer;
using overfly_vo::Frame;
using overfly_vo::detail::Connection;

void sleep_s(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// Says what it was told, and misbehaves in frame 2 where it is asked to.
class Scripted final : public overfly_vo::Estimator {
 public:
  Scripted(std::string behaviour, std::string argument)
      : behaviour_(std::move(behaviour)), argument_(std::move(argument)) {}

  std::string name() const override { return "scripted"; }
  std::string version() const override { return "1.2 (test)"; }

  overfly_vo::Parameters configure(const overfly_vo::Parameters& wanted) override {
    if (behaviour_ == "slow_start") sleep_s(60.0);
    if (wanted.count("nonsense") != 0) throw std::invalid_argument("unknown parameter nonsense");
    overfly_vo::Parameters all = {{"features", "2000"}, {"loop_closing", "false"}};
    for (const auto& [key, value] : wanted) all[key] = value;
    return all;
  }

  void calibrate(const overfly_vo::Calibration& camera) override {
    ++calibrations_;
    if (behaviour_ == "slow_calibration") sleep_s(60.0);
    std::string text = camera.camera + " " + std::to_string(camera.width_px) + "x" +
                       std::to_string(camera.height_px) + " " + camera.distortion;
    for (const double k : camera.distortion_coefficients)
      text.append(" ").append(std::to_string(k));
    log(overfly_vo::Level::kInfo, text + " at " + std::to_string(camera.rate_hz));
    log(overfly_vo::Level::kInfo,
        std::to_string(camera.fx_px) + " " + std::to_string(camera.fy_px) + " " +
            std::to_string(camera.cx_px) + " " + std::to_string(camera.cy_px));
    tell_parameters({{"read_back", "ORB 7"}});
  }

  Answer track(const Frame& frame) override {
    if (frames_++ == 2) misbehave();
    Answer answer;
    answer.state =
        frame.index < 1 ? overfly_vo::State::kInitialising : overfly_vo::State::kTracking;
    const auto t = static_cast<double>(frame.index);
    answer.position = {t, -2.0 * t, 0.5};
    answer.quaternion_xyzw = {0.0, 0.0, 0.6, 0.8};
    answer.scene_depth = 2.5;
    cpu_set_t cpus;
    ::sched_getaffinity(0, sizeof(cpus), &cpus);
    answer.counters = {{"first_pixel", frame.pixels[0]},
                       {"exposure_ns", static_cast<double>(frame.exposure_ns)},
                       {"pid", static_cast<double>(::getpid())},
                       {"child", static_cast<double>(child_)},
                       {"cpus", CPU_COUNT(&cpus)},
                       {"calibrations", calibrations_}};
    if (!frame.imu.empty()) answer.counters["turn_z"] = frame.imu.back().angular_rate_rad_s[2];
    for (const overfly_vo::RangeSample& sample : frame.range) {
      answer.counters["last_range_m"] = sample.range_m;
    }
    if (!frame.imu.empty()) answer.counters["imu_samples"] = static_cast<double>(frame.imu.size());
    answer.timings_ms = {{"match", 1.5}};
    const bool now = argument_ == "all" || argument_ == std::to_string(frame.index);
    if (behaviour_ == "nan_pose" && now) {
      answer.position[1] = std::numeric_limits<double>::quiet_NaN();
    }
    if (behaviour_ == "long_quaternion" && now) answer.quaternion_xyzw[3] = 2.0;
    if (behaviour_ == "bad_state") answer.state = static_cast<overfly_vo::State>(7);
    if (behaviour_ == "large_debug_image") answer.debug_image = {frame.width_px, 9999, 1, {1}};
    if (behaviour_ == "nan_figures") {
      answer.counters["parallax"] = std::numeric_limits<double>::quiet_NaN();
      answer.timings_ms["map"] = std::numeric_limits<double>::infinity();
    }
    if (behaviour_ == "inf_point" && frame.debug_wanted) {
      answer.map_points = {{1.0F, 2.0F, 3.0F},
                           {0.0F, 0.0F, std::numeric_limits<float>::infinity()}};
    }
    if (behaviour_ == "many_names") tell_many_names(&answer);
    if ((behaviour_ == "good" || behaviour_ == "late") && frame.debug_wanted) {
      answer.debug_image = overfly_vo::picture_of(frame);
      answer.map_points = {{1.0F, 2.0F, 3.0F}, {-1.0F, 0.0F, 8.5F}};
    }
    return answer;
  }

 private:
  /// 200 new counters and timings with each frame, and 1000 parameters.
  void tell_many_names(Answer* answer) {
    overfly_vo::Parameters parameters;
    for (int i = 0; i < 1000; ++i) {
      const std::string number = std::to_string(1000 * frames_ + i);
      parameters.emplace("p" + number, number);
      if (i >= 200) continue;
      answer->counters["c" + number] = 1.0;
      answer->timings_ms["t" + number] = 1.0;
    }
    tell_parameters(parameters);
  }

  void misbehave() {
    if (behaviour_ == "crash") {
      std::cout << "matching 17 features\n";
      std::cerr << "Segfault ahead, by \xFF design" << std::endl;
      std::abort();
    }
    if (behaviour_ == "quit") std::exit(3);
    if (behaviour_ == "throw") throw std::runtime_error("the map is empty");
    if (behaviour_ == "hang") sleep_s(60.0);
    if (behaviour_ == "late") sleep_s(std::stod(argument_));
    if (behaviour_ == "flood") {
      for (;;) log(overfly_vo::Level::kInfo, "and another thing");
    }
    if (behaviour_ == "shout") {
      const std::string line(999, 'x');
      for (int i = 0; i < 70'000; ++i) std::cout << line << "\n";
      std::cout << "the end of it" << std::endl;
    }
    if (behaviour_ == "eat") {
      hoard_.assign(std::stoul(argument_) * 1'000'000, 'm');
      const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
      while (std::chrono::steady_clock::now() < end) hoard_[0] = static_cast<char>(hoard_[0] + 1);
    }
    if (behaviour_ == "loose_grandchild") child_ = loose_grandchild();
    if (behaviour_ == "grandchild") {
      child_ = ::fork();
      if (child_ == 0) {
        sleep_s(60.0);
        std::_Exit(0);
      }
    }
  }

  /// A daemon: a session of its own, and no parent any more.
  static pid_t loose_grandchild() {
    std::array<int, 2> told{};
    if (::pipe(told.data()) != 0) return 0;
    const pid_t between = ::fork();
    if (between == 0) {
      ::setsid();
      const pid_t daemon = ::fork();
      if (daemon == 0) {
        sleep_s(60.0);
        std::_Exit(0);
      }
      const ssize_t written = ::write(told[1], &daemon, sizeof(daemon));
      std::_Exit(written == sizeof(daemon) ? 0 : 1);
    }
    ::waitpid(between, nullptr, 0);
    pid_t daemon = 0;
    return ::read(told[0], &daemon, sizeof(daemon)) == sizeof(daemon) ? daemon : 0;
  }

  std::string behaviour_;
  std::string argument_;
  int frames_ = 0;
  int calibrations_ = 0;
  pid_t child_ = 0;
  std::string hoard_;
};

std::string address() {
  const char* const text = std::getenv("OVERFLY_VO_ADDRESS");
  return text == nullptr ? "" : text;
}

/// Connects and sends bytes that the library would not send; then waits to be killed.
int say(const std::string& bytes) {
  const std::string path = address().substr(5);
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::memcpy(name.sun_path, path.c_str(), path.size() + 1);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0) return 1;
  if (::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0) return 1;
  sleep_s(60.0);
  return 0;
}

/// As run(), but does not offer to take frames from shared memory.
int run_by_socket(Scripted& estimator) {
  Connection connection(address());
  connection.send(overfly_vo::detail::kHello, "protocol 1\nname by_socket\n");
  connection.receive();
  overfly_vo::detail::ready(connection, overfly_vo::detail::kHello);
  try {
    for (;;) {
      const overfly_vo::detail::Message message = connection.receive();
      if (message.type == overfly_vo::detail::kStop) return 0;
      if (message.type == overfly_vo::detail::kFrame) {
        overfly_vo::detail::answer_frame(estimator, connection, message.payload, "");
      } else {
        overfly_vo::detail::ready(connection, static_cast<overfly_vo::detail::Type>(message.type));
      }
    }
  } catch (const std::exception&) {
    return 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string behaviour = argc > 1 ? argv[1] : "good";
  const std::string argument = argc > 2 ? argv[2] : "";
  if (behaviour == "no_start") {
    std::cerr << "ORBvoc.txt: no such file" << std::endl;
    return 3;
  }
  if (behaviour == "silent") return say("");
  if (behaviour == "web") return say("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  if (behaviour == "version_2") {
    return say(std::string("OVVO\x02\x00\x01\x00\x00\x00\x00\x00", 12));
  }
  if (behaviour == "text_version_9") {
    return say(std::string("OVVO\x01\x00\x01\x00\x13\x00\x00\x00protocol 9\nname me\n", 31));
  }
  if (behaviour == "huge") return say(std::string("OVVO\x01\x00\x01\x00\xFF\xFF\xFF\xFF", 12));
  if (behaviour == "server_message") {
    return say(std::string("OVVO\x01\x00\x0B\x00\x00\x00\x00\x00", 12));
  }
  if (behaviour == "stubborn") ::signal(SIGTERM, SIG_IGN);
  Scripted estimator(behaviour, argument);
  if (behaviour == "by_socket") return run_by_socket(estimator);
  const int code = overfly_vo::run(estimator);
  if (behaviour == "stubborn") sleep_s(60.0);
  return code;
}
