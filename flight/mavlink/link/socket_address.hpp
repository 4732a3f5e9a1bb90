// Numeric addresses of sockets. Private to link.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <string>

#include "core/outside/file_descriptor.hpp"
#include "core/result.hpp"
#include "flight/mavlink/link/link_address.hpp"

namespace overfly::flight::mavlink {

struct SocketAddress {
  sockaddr_storage name{};
  socklen_t size = 0;

  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&name); }
  [[nodiscard]] int family() const { return name.ss_family; }
  /// The same host and port.
  [[nodiscard]] bool same_as(const SocketAddress& other) const;
};

/// @pre the address is not serial
[[nodiscard]] SocketAddress socket_address(const LinkAddress& address);
/// A socket that does not block. Errors: kIo.
[[nodiscard]] Result<FileDescriptor> open_socket(const LinkAddress& address, int family, int type);
/// Binds. @return the port. Errors: kConflict if the address is in use; kIo.
[[nodiscard]] Result<std::uint16_t> bind_socket(int socket, const LinkAddress& address);
/// "ADDRESS: WHAT: the system's reason" with the code kIo.
[[nodiscard]] Error system_failure(const LinkAddress& address, const std::string& what, int number);

}  // namespace overfly::flight::mavlink
