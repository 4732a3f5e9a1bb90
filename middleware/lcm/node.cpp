#include "middleware/lcm/node.hpp"

#include <lcm/lcm.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>

#include "core/barrier.hpp"

namespace overfly::lcm {

Result<std::shared_ptr<Node>> Node::open(const Url& url, const std::atomic<bool>* cancel) {
  if (url.provider == "udpm") {
    // LCM itself would wait ten seconds for its own packet and report less.
    if (Status status = probe_multicast(url.address(), cancel); !status) return status.error();
  }
  lcm_t* const lcm = lcm_create(url.text().c_str());
  if (lcm == nullptr) return Error{ErrorCode::kIo, "LCM cannot open " + url.text()};
  const std::shared_ptr<Node> node(new Node(lcm));
  node->stop_fd_ = eventfd(0, EFD_CLOEXEC);
  if (node->stop_fd_ < 0) return Error{ErrorCode::kIo, "LCM: no more file descriptors"};
  return node;
}

Node::~Node() {
  stop();
  lcm_destroy(lcm_);
  if (stop_fd_ >= 0) close(stop_fd_);
}

Status Node::subscribe(const std::string& channel, Handler handler) {
  subscriptions_.push_back(std::make_unique<Subscription>(Subscription{std::move(handler)}));
  const auto call = [](const lcm_recv_buf_t* received, const char* /*channel*/, void* context) {
    const std::span message(static_cast<const std::uint8_t*>(received->data), received->data_size);
    // LCM's functions are not exception-safe; without memory the message is dropped.
    (void)contained([&] { static_cast<const Subscription*>(context)->handler(message); },
                    [](const char*) {});
  };
  if (lcm_subscribe(lcm_, channel.c_str(), call, subscriptions_.back().get()) == nullptr) {
    return Error{ErrorCode::kIo, "LCM cannot subscribe to " + channel};
  }
  return {};
}

void Node::start() {
  thread_ = std::thread([this] { hear(); });
}

void Node::stop() {
  if (!thread_.joinable()) return;
  eventfd_write(stop_fd_, 1);
  thread_.join();
}

void Node::hear() {
  std::array<pollfd, 2> sources{{{stop_fd_, POLLIN, 0}, {lcm_get_fileno(lcm_), POLLIN, 0}}};
  while (true) {
    if (poll(sources.data(), sources.size(), -1) < 0) {
      if (errno == EINTR) continue;
      return;
    }
    if (sources[0].revents != 0) return;
    // A log that is read ends with an error: there are no more messages.
    if (sources[1].revents != 0 && lcm_handle(lcm_) != 0) return;
  }
}

Status Node::publish(const std::string& channel, std::span<const std::uint8_t> message) {
  if (lcm_publish(
          lcm_, channel.c_str(), message.data(), static_cast<unsigned int>(message.size())) != 0) {
    return Error{ErrorCode::kIo,
                 "LCM cannot publish " + std::to_string(message.size()) + " bytes on " + channel};
  }
  return {};
}

}  // namespace overfly::lcm
