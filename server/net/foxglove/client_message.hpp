// Messages that a client of the Foxglove protocol may send, parsed (foxglove.websocket.v1 and
// foxglove.sdk.v1; docs/FOXGLOVE.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/result.hpp"

namespace overfly::net::foxglove {

/// Entries of one message.
inline constexpr std::size_t kMostEntries = 1024;

struct Subscribe {
  struct Entry {
    std::uint32_t subscription = 0;  ///< chosen by the client
    std::uint32_t channel = 0;
  };
  std::vector<Entry> entries;
};
struct Unsubscribe {
  std::vector<std::uint32_t> subscriptions;
};
struct GetParameters {
  std::vector<std::string> names;  ///< empty = all
  std::optional<std::string> id;
};
struct SetParameters {
  std::vector<std::pair<std::string, nlohmann::json>> values;
  std::optional<std::string> id;
};
/// Asks for changes of parameters, or does not want them any more.
struct WatchParameters {
  bool wanted = true;
  std::vector<std::string> names;  ///< empty = all
};
struct PlaybackControl {
  bool play = false;
  double speed = 1.0;
  std::optional<std::uint64_t> seek_utc_ns;
  std::string request_id;
};
/// What the protocol knows and this server does not offer.
struct NotOffered {
  std::string what;
};

using Command = std::variant<Subscribe,
                             Unsubscribe,
                             GetParameters,
                             SetParameters,
                             WatchParameters,
                             PlaybackControl,
                             NotOffered>;

/// Fields that are not known are ignored, as the protocol may get more.
/// Errors: kInvalidArgument naming the field and what it must be.
[[nodiscard]] Result<Command> parse_text(const std::string& text);
[[nodiscard]] Result<Command> parse_binary(std::span<const std::uint8_t> bytes);

}  // namespace overfly::net::foxglove
