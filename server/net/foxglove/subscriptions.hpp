// The channels that a client was told of, and which of them it subscribed to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/net/foxglove/channels.hpp"
#include "server/net/foxglove/client_message.hpp"

namespace overfly::net::foxglove {

class Subscriptions {
 public:
  /// Replaces the channels; subscriptions of the ones before end. Ids are never used again.
  /// @return the new channels
  const std::vector<Channel>& offer(const FlightNames& names);
  [[nodiscard]] const std::vector<Channel>& channels() const { return channels_; }
  /// Of a kind, in the order of `index`.
  [[nodiscard]] std::vector<Channel> channels(ChannelKind kind) const;

  /// @param refused  gets a sentence for each entry that is not possible: a channel that is not
  ///                 there or has a subscription, or an id in use
  /// @return the channels subscribed now
  std::vector<Channel> subscribe(const Subscribe& command, std::vector<std::string>* refused);
  void unsubscribe(const Unsubscribe& command, std::vector<std::string>* refused);

  /// The client's number for a channel that it subscribed to; else empty.
  [[nodiscard]] std::optional<std::uint32_t> of(ChannelKind kind, std::size_t index) const;

 private:
  using Key = std::pair<ChannelKind, std::size_t>;
  std::uint32_t next_id_ = 1;
  std::vector<Channel> channels_;
  std::map<Key, std::uint32_t> subscriptions_;
};

}  // namespace overfly::net::foxglove
