#include "flight/mavlink/link/socket_address.hpp"

#include <arpa/inet.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace overfly::flight::mavlink {

bool SocketAddress::same_as(const SocketAddress& other) const {
  if (family() != other.family()) return false;
  if (family() == AF_INET6) {
    const auto& a = reinterpret_cast<const sockaddr_in6&>(name);
    const auto& b = reinterpret_cast<const sockaddr_in6&>(other.name);
    return a.sin6_port == b.sin6_port && a.sin6_scope_id == b.sin6_scope_id &&
           std::memcmp(&a.sin6_addr, &b.sin6_addr, sizeof a.sin6_addr) == 0;
  }
  const auto& a = reinterpret_cast<const sockaddr_in&>(name);
  const auto& b = reinterpret_cast<const sockaddr_in&>(other.name);
  return a.sin_port == b.sin_port && a.sin_addr.s_addr == b.sin_addr.s_addr;
}

SocketAddress socket_address(const LinkAddress& address) {
  SocketAddress made;
  if (address.host.find(':') != std::string::npos) {
    auto& name = reinterpret_cast<sockaddr_in6&>(made.name);
    name.sin6_family = AF_INET6;
    name.sin6_port = htons(address.port);
    ::inet_pton(AF_INET6, address.host.c_str(), &name.sin6_addr);
    made.size = sizeof name;
  } else {
    auto& name = reinterpret_cast<sockaddr_in&>(made.name);
    name.sin_family = AF_INET;
    name.sin_port = htons(address.port);
    ::inet_pton(AF_INET, address.host.c_str(), &name.sin_addr);
    made.size = sizeof name;
  }
  return made;
}

Error system_failure(const LinkAddress& address, const std::string& what, int number) {
  const ErrorCode code = number == EADDRINUSE ? ErrorCode::kConflict
                         : number == ENOENT   ? ErrorCode::kNotFound
                                              : ErrorCode::kIo;
  return {code, address.text() + ": " + what + ": " + std::generic_category().message(number)};
}

Result<FileDescriptor> open_socket(const LinkAddress& address, int family, int type) {
  FileDescriptor socket(::socket(family, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket.open()) return system_failure(address, "creating a socket", errno);
  return socket;
}

Result<std::uint16_t> bind_socket(int socket, const LinkAddress& address) {
  const SocketAddress wanted = socket_address(address);
  if (::bind(socket, wanted.get(), wanted.size) != 0) {
    return system_failure(address, "listening", errno);
  }
  sockaddr_storage name{};
  socklen_t size = sizeof name;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&name), &size) != 0) {
    return system_failure(address, "listening", errno);
  }
  return ntohs(name.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(name).sin6_port
                                          : reinterpret_cast<const sockaddr_in&>(name).sin_port);
}

}  // namespace overfly::flight::mavlink
