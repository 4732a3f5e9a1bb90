// Messages that a client may send over the WebSocket, parsed (docs/PROTOCOL.md, "Client to
// server").
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/result.hpp"
#include "server/net/stream/playback_clock.hpp"
#include "server/net/stream/stream_request.hpp"
#include "server/views/view_service.hpp"

namespace overfly::net {

inline constexpr std::size_t kMaxRuns = 16;  ///< that one client watches

/// Starts watching a run, or changes its place on the clock.
struct WatchCommand {
  std::string run_id;
  /// Time of the clock at the run's beginning; empty = 0, or as it is for a run watched already.
  std::optional<std::int64_t> offset_ns;
  /// Number of rows that the client has, by data stream; the others are sent, also if the run is
  /// watched already.
  std::optional<std::map<std::string, std::size_t>> resume;
};
struct UnwatchCommand {
  std::string run_id;
};
struct SubscribeCommand {
  std::vector<StreamRequest> pictures;
  bool acknowledges = false;  ///< the client reports which pictures it has shown
};
/// Pictures that the client has shown: stream number and sequence number of the newest.
struct ShownCommand {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pictures;
};
/// Asks for a key picture, because one of the chain was lost.
struct KeyCommand {
  std::uint32_t stream_id = 0;
};
/// Empty fields keep their present value.
struct ViewCommand {
  std::string view;  ///< its name; empty = the one without a name
  std::optional<server::SceneMode> mode;
  std::optional<double> azimuth_rad;
  std::optional<double> elevation_rad;
  std::optional<double> distance_m;
  std::optional<bool> follow;
  std::optional<int> width_px;
  std::optional<int> height_px;
  std::optional<Eigen::Vector3d> eye_world_m;
  std::optional<server::SceneShow> show;
};
struct PlayCommand {};
struct PauseCommand {};
/// Exactly one of the two is set.
struct SeekCommand {
  std::optional<std::int64_t> t_ns;   ///< of the clock
  std::optional<std::int64_t> frame;  ///< of the run
  std::string run_id;                 ///< with a frame; empty = the first one watched
};
struct StepCommand {
  std::int64_t frames = 0;
  std::string run_id;  ///< whose frames; empty = the first one watched
};
struct SpeedCommand {
  double value = 1.0;
};
struct LoopCommand {
  bool value = false;
};
/// Empty = no range.
struct RangeCommand {
  std::optional<PlaybackClock::Range> range;
};
struct LiveCommand {};
/// Alignment of a run's estimates in `playback` and in the scenes.
struct AlignCommand {
  std::string run_id;
  std::string mode;
};

using ClientCommand = std::variant<WatchCommand,
                                   UnwatchCommand,
                                   SubscribeCommand,
                                   ShownCommand,
                                   KeyCommand,
                                   ViewCommand,
                                   PlayCommand,
                                   PauseCommand,
                                   SeekCommand,
                                   StepCommand,
                                   SpeedCommand,
                                   LoopCommand,
                                   RangeCommand,
                                   LiveCommand,
                                   AlignCommand>;

struct ClientMessage {
  std::optional<std::int64_t> request;  ///< repeated in the answer, also in an error
  Status status;                        ///< whether parsing succeeded
  ClientCommand command;                ///< valid only if status is ok
};

/// Errors (in `status`): kInvalidArgument naming the field, its value and the limit.
[[nodiscard]] ClientMessage parse_client_message(const std::string& text);

}  // namespace overfly::net
