// A link to vehicles as bytes: UDP, TCP or serial.
#pragma once

#include <poll.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "flight/mavlink/link/link_address.hpp"

namespace overfly::flight::mavlink {

/// Who is at the other end: datagrams of up to kMaxPeers senders come by one UDP socket, all other
/// links have one peer. Its number is below kMaxPeers; a peer that was not heard for longest gives
/// its number to a new one.
using PeerId = std::uint32_t;
inline constexpr PeerId kMaxPeers = 16;

/// A "tcp-listen:" connection on which nothing was received for this time gives its place to a new
/// one, and a TCP connection ends if its other side does not answer the network for it.
inline constexpr std::chrono::seconds kSilenceLimit{10};

/// An open link. No call blocks. Not thread-safe.
class ByteLink {
 public:
  virtual ~ByteLink() = default;
  ByteLink(const ByteLink&) = delete;
  ByteLink& operator=(const ByteLink&) = delete;

  /// Adds the descriptors to wait for.
  virtual void add_to_poll(std::vector<pollfd>& descriptors) const = 0;

  using TimePoint = std::chrono::steady_clock::time_point;
  using Take = std::function<void(PeerId, std::span<const std::uint8_t>)>;
  /// A number belongs to another peer from now on.
  using Replace = std::function<void(PeerId)>;
  /// Passes on what has arrived, at most 256 KiB, so that a flood of bytes does not keep the
  /// caller from its other work; finishes connecting; sends what waits to be sent. `replace` is
  /// called after the last bytes of the old peer and before the first ones of the new peer.
  /// Errors: kIo with the system's reason; the link has to be opened again.
  [[nodiscard]] virtual Status exchange(TimePoint now,
                                        const Take& take,
                                        const Replace& replace) = 0;

  /// Whether there is a peer to send to.
  [[nodiscard]] virtual bool connected() const = 0;
  /// Sends to one peer. What a slow peer does not take waits in a buffer of 64 KiB, and is dropped
  /// whole if it does not fit.
  /// @return whether the bytes were sent or wait to be sent; always false on a read-only link
  bool send(PeerId peer, std::span<const std::uint8_t> bytes) {
    return !read_only_ && do_send(peer, bytes);
  }

  /// The address with the actual port if 0 was asked for.
  [[nodiscard]] const LinkAddress& address() const { return address_; }

 protected:
  ByteLink(LinkAddress address, bool read_only)
      : address_(std::move(address)), read_only_(read_only) {}
  void set_port(std::uint16_t port) { address_.port = port; }

 private:
  virtual bool do_send(PeerId peer, std::span<const std::uint8_t> bytes) = 0;

  LinkAddress address_;
  bool read_only_;
};

}  // namespace overfly::flight::mavlink
