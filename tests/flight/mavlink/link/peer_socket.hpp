// The other end of a link, for tests: plain sockets on the loopback interface.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <cstdint>
#include <span>
#include <vector>

#include "core/outside/file_descriptor.hpp"

namespace overfly::flight::testing {

/// A socket of 127.0.0.1. Waits at most 5 s.
class PeerSocket {
 public:
  /// @param type  SOCK_DGRAM or SOCK_STREAM
  explicit PeerSocket(int type) : socket_(::socket(AF_INET, type | SOCK_CLOEXEC, 0)) {}
  explicit PeerSocket(FileDescriptor socket) : socket_(std::move(socket)) {}

  bool connect_to(std::uint16_t port) {
    const sockaddr_in name = loopback(port);
    return ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0;
  }
  /// Binds, and listens with TCP. @return the port
  std::uint16_t bind_to(std::uint16_t port, bool listens) {
    const int on = 1;
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in name = loopback(port);
    socklen_t size = sizeof name;
    if (::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&name), size) != 0) return 0;
    if (listens && ::listen(socket_.get(), 4) != 0) return 0;
    ::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&name), &size);
    return ntohs(name.sin_port);
  }
  PeerSocket accept() {
    (void)readable(5000);
    return PeerSocket(FileDescriptor(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC)));
  }
  bool send(std::span<const std::uint8_t> bytes) {
    return ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(bytes.size());
  }
  /// What arrives within `patience_ms`; empty: nothing, or the end.
  std::vector<std::uint8_t> receive(int patience_ms = 5000) {
    std::vector<std::uint8_t> bytes(65536);
    if (!readable(patience_ms)) return {};
    const ssize_t got = ::recv(socket_.get(), bytes.data(), bytes.size(), 0);
    bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return bytes;
  }
  bool readable(int patience_ms) {
    pollfd ready{socket_.get(), POLLIN, 0};
    return ::poll(&ready, 1, patience_ms) == 1;
  }
  void close() { socket_.close(); }
  [[nodiscard]] int get() const { return socket_.get(); }

 private:
  static sockaddr_in loopback(std::uint16_t port) {
    sockaddr_in name{};
    name.sin_family = AF_INET;
    name.sin_port = htons(port);
    name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return name;
  }

  FileDescriptor socket_;
};

}  // namespace overfly::flight::testing
