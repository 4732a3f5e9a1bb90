#include "flight/mavlink/link/udp_link.hpp"

#include <array>
#include <cerrno>

#include "flight/mavlink/link/socket_address.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr std::size_t kMaxDatagramBytes = 65536;
constexpr std::size_t kDatagramsAtOnce = 256;
/// Asked for; the system may grant less. 4 s of 5000 messages/s of 50 bytes.
constexpr int kReceiveBufferBytes = 1 << 20;

class UdpLink final : public ByteLink {
 public:
  UdpLink(LinkAddress address, bool read_only, FileDescriptor socket)
      : ByteLink(std::move(address), read_only),
        socket_(std::move(socket)),
        buffer_(kMaxDatagramBytes) {}

  using ByteLink::set_port;
  /// Answers come from this peer only.
  void connect_to(const SocketAddress& peer) {
    fixed_ = true;
    peers_[0] = {peer, ++heard_};
    count_ = 1;
  }

  void add_to_poll(std::vector<pollfd>& descriptors) const override {
    descriptors.push_back({socket_.get(), POLLIN, 0});
  }
  [[nodiscard]] Status exchange(TimePoint now, const Take& take, const Replace& replace) override;
  [[nodiscard]] bool connected() const override { return count_ > 0; }

 private:
  struct Peer {
    SocketAddress address;
    std::uint64_t heard = 0;  ///< the larger, the later
  };

  bool do_send(PeerId peer, std::span<const std::uint8_t> bytes) override;
  PeerId peer_of(const SocketAddress& sender, const Replace& replace);

  FileDescriptor socket_;
  std::vector<std::uint8_t> buffer_;
  std::array<Peer, kMaxPeers> peers_;
  PeerId count_ = 0;
  std::uint64_t heard_ = 0;
  bool fixed_ = false;
};

PeerId UdpLink::peer_of(const SocketAddress& sender, const Replace& replace) {
  PeerId found = 0;
  while (found < count_ && !peers_[found].address.same_as(sender)) ++found;
  if (found == count_) {
    if (count_ < kMaxPeers) {
      ++count_;
    } else {
      for (PeerId i = 0; i < kMaxPeers; ++i) {
        if (i == 0 || peers_[i].heard < peers_[found].heard) found = i;
      }
      replace(found);
    }
    peers_[found].address = sender;
  }
  peers_[found].heard = ++heard_;
  return found;
}

Status UdpLink::exchange(TimePoint /*now*/, const Take& take, const Replace& replace) {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < kDatagramsAtOnce && bytes < (std::size_t{1} << 18U); ++i) {
    SocketAddress sender;
    sender.size = sizeof sender.name;
    const ssize_t got = ::recvfrom(socket_.get(),
                                   buffer_.data(),
                                   buffer_.size(),
                                   MSG_DONTWAIT,
                                   reinterpret_cast<sockaddr*>(&sender.name),
                                   &sender.size);
    if (got < 0) {
      // A refused datagram of before: the peer may start later.
      if (errno == EINTR || errno == ECONNREFUSED) continue;
      if (errno == EAGAIN || errno == EWOULDBLOCK) return {};
      return system_failure(address(), "receiving", errno);
    }
    bytes += static_cast<std::size_t>(got);
    if (fixed_ && !peers_[0].address.same_as(sender)) continue;
    take(fixed_ ? 0 : peer_of(sender, replace),
         std::span(buffer_).first(static_cast<std::size_t>(got)));
  }
  return {};
}

bool UdpLink::do_send(PeerId peer, std::span<const std::uint8_t> bytes) {
  if (peer >= count_) return false;
  const SocketAddress& to = peers_[peer].address;
  const ssize_t sent = ::sendto(
      socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL, to.get(), to.size);
  return sent == static_cast<ssize_t>(bytes.size());
}

}  // namespace

Result<std::unique_ptr<ByteLink>> open_udp(const LinkAddress& address, bool read_only) {
  const SocketAddress name = socket_address(address);
  Result<FileDescriptor> socket = open_socket(address, name.family(), SOCK_DGRAM);
  if (!socket) return socket.error();
  const int number = socket->get();
  // Best effort: with less, a long pause of this program loses messages.
  (void)::setsockopt(
      number, SOL_SOCKET, SO_RCVBUF, &kReceiveBufferBytes, sizeof kReceiveBufferBytes);
  auto link = std::make_unique<UdpLink>(address, read_only, std::move(*socket));
  if (address.kind == LinkKind::kUdp) {
    link->connect_to(name);
  } else {
    const Result<std::uint16_t> port = bind_socket(number, address);
    if (!port) return port.error();
    link->set_port(*port);
  }
  return std::unique_ptr<ByteLink>(std::move(link));
}

}  // namespace overfly::flight::mavlink
