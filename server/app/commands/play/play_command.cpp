// overfly play: a recorded flight on a MAVLink link, LCM channels or ROS topics.
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "flight/mavlink/link/link_address.hpp"
#include "flight/playback/play.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/commands/play/play_source.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/place_argument.hpp"
#include "server/app/stop_signal.hpp"

namespace overfly::app {
namespace {

namespace playback = flight::playback;

constexpr const char* kDefaultLink = "udp:127.0.0.1:14550";

struct PlayArguments {
  std::string file;
  std::string link;
  std::string lcm;
  bool ros = false;
  std::string ros_master;
  double speed = 1.0;
  double from_s = 0.0;
  bool repeat = false;
  std::string source;
  std::string origin;
  double rate_hz = 50.0;
};

/// Without a choice the master that ROS's own programs would use.
std::string master_uri(const PlayArguments& arguments) {
  if (!arguments.ros_master.empty()) return arguments.ros_master;
  const char* const from_environment = std::getenv("ROS_MASTER_URI");
  return from_environment != nullptr && *from_environment != '\0'
             ? from_environment
             : playback::RosTarget().master_uri;
}

Result<PlaybackTarget> target_of(const PlayArguments& arguments) {
  const bool is_ros = arguments.ros || !arguments.ros_master.empty();
  if ((arguments.link.empty() ? 0 : 1) + (arguments.lcm.empty() ? 0 : 1) + (is_ros ? 1 : 0) > 1) {
    return Error{ErrorCode::kInvalidArgument, "--link, --lcm, --ros: give one of them"};
  }
  if (!arguments.lcm.empty()) return PlaybackTarget(LcmTarget{arguments.lcm});
  if (is_ros) {
    playback::RosTarget ros;
    ros.master_uri = master_uri(arguments);
    return PlaybackTarget(ros);
  }
  const auto link = flight::mavlink::parse_link_address(
      arguments.link.empty() ? kDefaultLink : arguments.link, "--link");
  if (!link) return link.error();
  return PlaybackTarget(*link);
}

Result<OpenedPlayback> open_recording(const PlayArguments& arguments) {
  const Result<PlaybackTarget> target = target_of(arguments);
  if (!target) return target.error();
  PlayedFile played{arguments.file, arguments.source, std::nullopt, arguments.rate_hz};
  if (!arguments.origin.empty()) {
    const Result<Geodetic> origin = place_from("--origin", arguments.origin);
    if (!origin) return origin.error();
    played.origin = *origin;
  }
  return open_playback(played, *target, &catch_stop_signals());
}

/// Lines of standard input, without waiting for them.
class CommandInput {
 public:
  std::vector<playback::PlaybackCommand> take() {
    constexpr std::size_t kLongestLine = 200;
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    // One piece for each call: standard input may never end.
    if (open_ && ::poll(&ready, 1, 0) == 1) {
      std::array<char, 256> bytes{};
      const ssize_t got = ::read(STDIN_FILENO, bytes.data(), bytes.size());
      open_ = got > 0;
      if (open_) {
        line_.append(bytes.data(), static_cast<std::size_t>(got));
      } else if (!line_.empty()) {
        line_ += '\n';  // the last line may lack its end
      }
      if (line_.size() > 64 * kLongestLine) line_.clear();
    }
    std::vector<playback::PlaybackCommand> commands;
    for (std::size_t end = line_.find('\n'); end != std::string::npos; end = line_.find('\n')) {
      const std::string line = line_.substr(0, end);
      line_.erase(0, end + 1);
      if (line.empty()) continue;
      const auto command = playback::parse_playback_command(line);
      if (command) {
        commands.push_back(*command);
      } else {
        std::cerr << command.error().message << std::endl;
      }
    }
    return commands;
  }

 private:
  std::string line_;
  bool open_ = true;
};

int play(const PlayArguments& arguments) {
  if (!(arguments.speed >= playback::kSlowest && arguments.speed <= playback::kFastest)) {
    return report({ErrorCode::kInvalidArgument,
                   "--speed " + std::to_string(arguments.speed) + ": must be in [0.01, 1000]"});
  }
  const Result<OpenedPlayback> opened = open_recording(arguments);
  if (!opened) return report(opened.error());
  for (const std::string& warning : opened->warnings) std::cerr << "warning: " << warning << "\n";
  playback::PlaybackOutput& output = *opened->output;
  const double length_s = 1e-6 * static_cast<double>(output.duration_us());
  if (!(arguments.from_s >= 0.0 && arguments.from_s <= length_s)) {
    return report({ErrorCode::kInvalidArgument,
                   "--from " + std::to_string(arguments.from_s) + ": must be in [0, " +
                       std::to_string(length_s) + "] s"});
  }
  if (arguments.repeat && arguments.from_s >= length_s) {
    return report({ErrorCode::kInvalidArgument,
                   "--from " + std::to_string(arguments.from_s) + ": must be before the end, " +
                       std::to_string(length_s) + " s, with --repeat"});
  }
  playback::PlaybackOptions options;
  options.speed = arguments.speed;
  options.from_us = static_cast<std::int64_t>(arguments.from_s * 1e6);
  options.repeat = arguments.repeat;
  CommandInput input;
  playback::PlaybackPorts ports;
  ports.now = [] { return std::chrono::steady_clock::now(); };
  ports.commands = [&] { return input.take(); };
  ports.opened = [&](const playback::PlaybackOutput& open) {
    if (!opened->description.empty()) std::cout << opened->description << ": ";
    std::cout << open.count() << " messages, " << length_s << " s, on " << open.place()
              << std::endl;
  };
  ports.changed = [](const playback::PlaybackClock& clock, std::int64_t position_us) {
    std::fprintf(stderr,
                 "%s at %.3f s, speed %g\n",
                 clock.paused() ? "paused" : "playing",
                 1e-6 * static_cast<double>(position_us),
                 clock.speed());
  };
  const auto played = playback::play(output, options, ports, catch_stop_signals());
  if (!played) return report(played.error());
  std::cout << played->sent << " messages sent";
  if (played->unsent > 0) std::cout << ", " << played->unsent << " that nobody took";
  std::cout << std::endl;
  return catch_stop_signals() ? kExitCancelled : kExitOk;
}

}  // namespace

void add_play_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<PlayArguments>();
  CLI::App* const command =
      app.add_subcommand("play",
                         "Play a recording onto a MAVLink link, LCM channels or ROS topics; "
                         "standard input takes pause, play, speed X, seek S, quit");
  command
      ->add_option("file",
                   arguments->file,
                   ".tlog, or any other flight log, pose file or folder of a run, whose truth is "
                   "flown by a vehicle")
      ->required();
  command->add_option(
      "--link",
      arguments->link,
      "udp:HOST:PORT, tcp-listen:HOST:PORT, ...; by default " + std::string(kDefaultLink));
  command->add_option("--lcm",
                      arguments->lcm,
                      "LCM URL: the flight as truth_t, gps_t and imu_t (\"udpm://?ttl=0\")");
  command->add_flag("--ros", arguments->ros, "The flight on ROS 1 topics of MAVROS");
  command->add_option("--ros-master",
                      arguments->ros_master,
                      "http://HOST:PORT, with --ros; by default $ROS_MASTER_URI, or port 11311 of "
                      "this machine");
  command->add_option("--speed", arguments->speed, "Times the recording's")->capture_default_str();
  command->add_option("--from", arguments->from_s, "Start [s]")->capture_default_str();
  command->add_flag("--repeat", arguments->repeat, "Start again at the end");
  command->add_option("--source",
                      arguments->source,
                      "Stream of the positions of a flight log, as listed by `log info`");
  command->add_option("--origin",
                      arguments->origin,
                      "LAT,LON,HEIGHT: where positions in metres count from, if the file does not "
                      "state it");
  command->add_option("--rate-hz", arguments->rate_hz, "Of the messages of a flight, 1 to 1000")
      ->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = play(*arguments); });
}

}  // namespace overfly::app
