// Messages that the server sends to a client of the Foxglove protocol.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/net/foxglove/channels.hpp"

namespace overfly::net::foxglove {

/// What the server says of itself at the beginning.
struct ServerInfo {
  std::string name;
  std::string session;
  nlohmann::json metadata = nlohmann::json::object();
  /// The recorded time [Unix time, ns]; with it the client may control the playback.
  std::optional<std::pair<std::int64_t, std::int64_t>> span_utc_ns;
};
[[nodiscard]] std::string info_text(const ServerInfo& info);

enum class StatusLevel { kInfo = 0, kWarning = 1, kError = 2 };
/// @param id  a later status with it replaces this one; may be empty
[[nodiscard]] std::string status_text(StatusLevel level,
                                      const std::string& message,
                                      const std::string& id = "");

[[nodiscard]] std::string advertise_text(const std::vector<Channel>& channels);
[[nodiscard]] std::string unadvertise_text(const std::vector<Channel>& channels);

struct Parameter {
  std::string name;
  nlohmann::json value;
  bool is_float = false;  ///< a number that need not be whole
};
[[nodiscard]] std::string parameters_text(const std::vector<Parameter>& parameters,
                                          const std::optional<std::string>& id);

using Bytes = std::vector<std::uint8_t>;
/// What a message of a channel begins with.
[[nodiscard]] Bytes data_head(std::uint32_t subscription, std::int64_t log_time_ns);
[[nodiscard]] Bytes time_message(std::int64_t utc_ns);

enum class PlaybackStatus : std::uint8_t { kPlaying = 0, kPaused = 1, kBuffering = 2, kEnded = 3 };
struct PlaybackState {
  PlaybackStatus status = PlaybackStatus::kPaused;
  std::int64_t utc_ns = 0;
  double speed = 1.0;
  bool did_seek = false;
  std::string request_id;  ///< empty = not asked for
};
[[nodiscard]] Bytes playback_message(const PlaybackState& state);

}  // namespace overfly::net::foxglove
