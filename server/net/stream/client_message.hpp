// Messages that a client may send over the WebSocket, parsed (docs/PROTOCOL.md, "Client to
// server").
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

/// One requested picture stream.
struct StreamRequest {
  std::string name;  ///< "camera", "scene" or "debug/NAME"
  double max_hz = 31.0;
  int quality = 75;
  int max_width_px = 1280;
  std::string camera = {};  ///< for the stream "camera"; empty = the run's first
  bool operator==(const StreamRequest&) const = default;
};

struct AttachCommand {
  std::string run_id;
  /// Number of rows that the client has, by data stream.
  std::map<std::string, std::size_t> resume;
};
struct DetachCommand {};
struct SubscribeCommand {
  std::vector<StreamRequest> streams;
};
/// Empty fields keep their present value.
struct ViewCommand {
  std::optional<server::SceneMode> mode;
  std::optional<double> azimuth_rad;
  std::optional<double> elevation_rad;
  std::optional<double> distance_m;
  std::optional<bool> follow;
  std::optional<int> width_px;
  std::optional<int> height_px;
};
struct PlayCommand {};
struct PauseCommand {};
/// Exactly one of the two is set.
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
/// Alignment of the estimates in `playback` and in the scene.
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
  std::optional<std::int64_t> request;  ///< repeated in the answer, also in an error
  Status status;                        ///< whether parsing succeeded
  ClientCommand command;                ///< valid only if status is ok
};

/// Errors (in `status`): kInvalidArgument naming the field, its value and the limit.
[[nodiscard]] ClientMessage parse_client_message(const std::string& text);

}  // namespace overfly::net
