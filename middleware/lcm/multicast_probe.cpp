#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <system_error>

#include "core/cancellable_wait.hpp"
#include "middleware/lcm/node.hpp"

namespace overfly::lcm {
namespace {

constexpr std::chrono::milliseconds kPatience{500};

class Socket {
 public:
  Socket() : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  ~Socket() {
    if (fd_ >= 0) close(fd_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  [[nodiscard]] int fd() const { return fd_; }

 private:
  int fd_;
};

Error failure(const std::string& address, const std::string& what) {
  return {ErrorCode::kIo,
          "multicast to " + address + ": " + what +
              "; add a route (ip route add 224.0.0.0/4 dev lo; ip link set lo multicast on) "
              "and allow UDP in the firewall"};
}

std::string last_failure() { return std::system_category().message(errno); }

bool join(int fd, in_addr group) {
  ip_mreq membership{};
  membership.imr_multiaddr = group;
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  const unsigned char ttl = 0;
  return setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) == 0 &&
         setsockopt(fd, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof(ttl)) == 0;
}

}  // namespace

Status probe_multicast(const std::string& address, const std::atomic<bool>* cancel) {
  const Socket socket;
  sockaddr_in own{};
  own.sin_family = AF_INET;
  socklen_t length = sizeof(own);
  // The socket functions use one type for the addresses of every family.
  auto* const generic = reinterpret_cast<sockaddr*>(&own);
  if (socket.fd() < 0 || bind(socket.fd(), generic, length) != 0 ||
      getsockname(socket.fd(), generic, &length) != 0) {
    return failure(address, last_failure());
  }
  sockaddr_in group = own;
  if (inet_pton(AF_INET, address.c_str(), &group.sin_addr) != 1) {
    return failure(address, "not an IPv4 address");
  }
  if (!join(socket.fd(), group.sin_addr)) return failure(address, last_failure());
  const std::array<std::uint8_t, 8> sent{'o', 'v', 'e', 'r', 'f', 'l', 'y', '?'};
  if (sendto(socket.fd(),
             sent.data(),
             sent.size(),
             0,
             reinterpret_cast<sockaddr*>(&group),
             sizeof(group)) < 0) {
    return failure(address, last_failure());
  }
  pollfd waiting{socket.fd(), POLLIN, 0};
  const bool back = wait_unless_cancelled(
      cancel, std::chrono::steady_clock::now() + kPatience, [&](std::chrono::nanoseconds timeout) {
        const auto timeout_ms = std::chrono::ceil<std::chrono::milliseconds>(timeout);
        return poll(&waiting, 1, static_cast<int>(timeout_ms.count())) == 1;
      });
  if (back) return {};
  if (is_cancelled(cancel)) return cancelled("multicast to " + address);
  return failure(address, "a sent packet was not received");
}

}  // namespace overfly::lcm
