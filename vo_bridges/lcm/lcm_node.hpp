// One end of an LCM network: publishes, and hears on a thread of its own.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "core/result.hpp"
#include "vo_bridges/lcm/lcm_url.hpp"

struct _lcm_t;  // NOLINT(bugprone-reserved-identifier): the name that LCM gave it

namespace overfly {

class LcmNode {
 public:
  /// Called on the node's thread; must neither throw nor stop the node.
  using Handler = std::function<void(std::span<const std::uint8_t> message)>;

  /// Errors: kIo where LCM cannot be opened, with what to do about it; kCancelled.
  static Result<std::shared_ptr<LcmNode>> open(const LcmUrl& url,
                                               const std::atomic<bool>* cancel = nullptr);
  /// Stops.
  ~LcmNode();
  LcmNode(const LcmNode&) = delete;
  LcmNode& operator=(const LcmNode&) = delete;

  /// @param channel  letters, digits, "_", "-" and "/" alone (LCM takes it as a regular expression)
  /// @pre not started
  /// Errors: kIo.
  [[nodiscard]] Status subscribe(const std::string& channel, Handler handler);
  /// Begins to hear. Once.
  void start();
  /// Ends hearing: no handler runs after that.
  void stop();
  /// May be called from any thread, handlers included.
  /// Errors: kIo naming the channel.
  [[nodiscard]] Status publish(const std::string& channel, std::span<const std::uint8_t> message);

 private:
  struct Subscription {
    Handler handler;
  };
  explicit LcmNode(_lcm_t* lcm) : lcm_(lcm) {}
  void hear();

  _lcm_t* lcm_;
  int stop_fd_ = -1;  ///< readable when the thread shall end
  std::vector<std::unique_ptr<Subscription>> subscriptions_;
  std::thread thread_;
};

/// Publishes a message of a type that lcm-gen made.
template <typename Message>
[[nodiscard]] Status publish_message(LcmNode& node,
                                     const std::string& channel,
                                     const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const int size = message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  if (size < 0) return Error{ErrorCode::kInternal, "cannot encode the message of " + channel};
  return node.publish(channel, bytes);
}

/// Whether multicast from this machine comes back to it: a packet is sent to a group and awaited.
/// Errors: kIo saying what failed and how to mend it; kCancelled.
[[nodiscard]] Status probe_multicast(const std::string& address,
                                     const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly
