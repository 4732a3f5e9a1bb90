#include "middleware/lcm/channel_listener.hpp"

#include <utility>

#include "middleware/lcm/node.hpp"

namespace overfly::lcm {

Result<std::shared_ptr<void>> listen_to_channel(
    const std::string& url,
    const std::string& channel,
    std::function<void(std::span<const std::uint8_t>)> take,
    const std::atomic<bool>* cancel) {
  const Result<Url> parsed = parse_url(url);
  if (!parsed) return parsed.error();
  if (parsed->provider == "file") {
    return Error{ErrorCode::kInvalidArgument, "LCM URL " + url + ": must be udpm:// or memq://"};
  }
  const auto node = Node::open(with_receive_buffer(*parsed), cancel);
  if (!node) return node.error();
  if (Status status = (*node)->subscribe(channel, std::move(take)); !status) return status.error();
  (*node)->start();
  return std::shared_ptr<void>(*node);
}

}  // namespace overfly::lcm
