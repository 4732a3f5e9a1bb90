#include "server/net/foxglove/subscriptions.hpp"

#include <algorithm>

namespace overfly::net::foxglove {

const std::vector<Channel>& Subscriptions::offer(const FlightNames& names) {
  subscriptions_.clear();
  channels_ = channels_of(names, next_id_);
  next_id_ += static_cast<std::uint32_t>(channels_.size());
  return channels_;
}

std::vector<Channel> Subscriptions::channels(ChannelKind kind) const {
  std::vector<Channel> found;
  std::copy_if(
      channels_.begin(), channels_.end(), std::back_inserter(found), [&](const Channel& channel) {
        return channel.kind == kind;
      });
  return found;
}

std::vector<Channel> Subscriptions::subscribe(const Subscribe& command,
                                              std::vector<std::string>* refused) {
  std::vector<Channel> added;
  for (const Subscribe::Entry& entry : command.entries) {
    const auto channel =
        std::find_if(channels_.begin(), channels_.end(), [&](const Channel& known) {
          return known.id == entry.channel;
        });
    const bool id_in_use =
        std::any_of(subscriptions_.begin(), subscriptions_.end(), [&](const auto& known) {
          return known.second == entry.subscription;
        });
    if (channel == channels_.end()) {
      refused->push_back("channel " + std::to_string(entry.channel) + " does not exist");
    } else if (id_in_use) {
      refused->push_back("subscription " + std::to_string(entry.subscription) + " is in use");
    } else if (!subscriptions_.emplace(Key{channel->kind, channel->index}, entry.subscription)
                    .second) {
      refused->push_back(channel->topic + " is subscribed to already");
    } else {
      added.push_back(*channel);
    }
  }
  return added;
}

void Subscriptions::unsubscribe(const Unsubscribe& command, std::vector<std::string>* refused) {
  for (const std::uint32_t subscription : command.subscriptions) {
    const std::size_t ended = std::erase_if(
        subscriptions_, [&](const auto& known) { return known.second == subscription; });
    if (ended == 0) {
      refused->push_back("subscription " + std::to_string(subscription) + " does not exist");
    }
  }
}

std::optional<std::uint32_t> Subscriptions::of(ChannelKind kind, std::size_t index) const {
  const auto found = subscriptions_.find({kind, index});
  return found == subscriptions_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace overfly::net::foxglove
