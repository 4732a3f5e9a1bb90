// What a client may say over the WebSocket, parsed (docs/PROTOCOL.md, "Client to server").
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/result.hpp"
#include "server/views/view_service.hpp"

namespace overfly::net {

/// One picture stream that a client wants.
struct StreamWish {
  std::string name;  ///< "camera", "scene" or "debug/NAME"
  double max_hz = 31.0;
  int quality = 75;
  int max_width_px = 1280;
  std::string camera = {};  ///< of the stream "camera"; empty = the run's first
  bool operator==(const StreamWish&) const = default;
};

struct AttachCommand {
  std::string run_id;
  std::map<std::string, std::size_t> resume;  ///< rows that the client has, by data stream
};
struct DetachCommand {};
struct SubscribeCommand {
  std::vector<StreamWish> streams;
};
/// Fields that are empty stay as they are.
struct ViewCommand {
  std::optional<engine::SceneMode> mode;
  std::optional<double> azimuth_rad;
  std::optional<double> elevation_rad;
  std::optional<double> distance_m;
  std::optional<bool> follow;
  std::optional<int> width_px;
  std::optional<int> height_px;
};
struct PlayCommand {};
struct PauseCommand {};
/// One of the two is given.
struct SeekCommand {
  std::optional<std::int64_t> t_ns;
  std::optional<std::int64_t> frame;
};
struct StepCommand {
  std::int64_t frames = 0;
};
struct SpeedCommand {
  double value = 1.0;
};
struct LoopCommand {
  bool value = false;
};
struct LiveCommand {};
/// Where the estimates of `playback` and of the scene lie.
struct AlignCommand {
  std::string mode;
};

using ClientCommand = std::variant<AttachCommand,
                                   DetachCommand,
                                   SubscribeCommand,
                                   ViewCommand,
                                   PlayCommand,
                                   PauseCommand,
                                   SeekCommand,
                                   StepCommand,
                                   SpeedCommand,
                                   LoopCommand,
                                   LiveCommand,
                                   AlignCommand>;

struct ClientMessage {
  std::optional<std::int64_t> request;  ///< to be repeated in the answer, also in an error
  Status status;                        ///< whether it was understood
  ClientCommand command;                ///< meaningful only if it was
};

/// Errors (in `status`): kInvalidArgument naming the field, its value and the limit.
[[nodiscard]] ClientMessage parse_client_message(const std::string& text);

}  // namespace overfly::net
