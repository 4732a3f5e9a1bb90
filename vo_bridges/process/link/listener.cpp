#include "vo_bridges/process/link/listener.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

namespace overfly::process {

namespace {

Error bad_address(const std::string& address, const std::string& why) {
  return {ErrorCode::kInvalidArgument, "listen = '" + address + "': " + why};
}

std::string system_message(int number) { return std::generic_category().message(number); }

std::optional<sockaddr_un> unix_name(const std::string& path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof(name.sun_path)) return std::nullopt;
  std::memcpy(name.sun_path, path.c_str(), path.size() + 1);
  return name;
}

/// Describes what exists at a path (links are not followed); empty for a socket or nothing.
std::string other_than_socket(const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || S_ISSOCK(status.st_mode)) return "";
  if (S_ISLNK(status.st_mode)) return "a link";
  return S_ISDIR(status.st_mode) ? "a folder" : "a file";
}

/// Whether a socket file was left behind by a dead program. A living one refuses a datagram socket
/// because of its type, and does not take the probe for its estimator.
bool is_stale(const sockaddr_un& name) {
  const FileDescriptor probe(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  return ::connect(probe.get(), reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0 &&
         errno == ECONNREFUSED;
}

/// The port assigned to a socket.
int port_of(int socket) {
  sockaddr_storage name{};
  socklen_t size = sizeof(name);
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&name), &size) != 0) return 0;
  if (name.ss_family == AF_INET6) {
    return ntohs(reinterpret_cast<const sockaddr_in6*>(&name)->sin6_port);
  }
  return ntohs(reinterpret_cast<const sockaddr_in*>(&name)->sin_port);
}

}  // namespace

Listener::Listener(Listener&& other) noexcept
    : socket_(std::move(other.socket_)),
      address_(std::exchange(other.address_, {})),
      folder_(std::exchange(other.folder_, std::nullopt)),
      path_(std::exchange(other.path_, {})) {}

Listener::~Listener() {
  std::error_code ignored;  // a file that cannot be removed stays
  if (std::filesystem::symlink_status(path_, ignored).type() ==
      std::filesystem::file_type::socket) {
    std::filesystem::remove(path_, ignored);
  }
}

Result<Listener> Listener::open(const std::string& address) {
  if (address.starts_with("unix:")) return open_unix(address.substr(5));
  if (!address.starts_with("tcp:"))
    return bad_address(address, "must be unix:PATH or tcp:HOST:PORT");
  const std::size_t colon = address.rfind(':');
  if (colon < 5) return bad_address(address, "must be tcp:HOST:PORT");
  const std::string port = address.substr(colon + 1);
  int number = -1;
  const auto [end, failure] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (failure != std::errc{} || end != port.data() + port.size() || number < 0 || number > 65535) {
    return bad_address(address, "the port must be in [0, 65535]");
  }
  return open_tcp(address.substr(4, colon - 4), port);
}

Result<Listener> Listener::open_private() {
  Result<PrivateFolder> folder = PrivateFolder::create();
  if (!folder) return folder.error();
  Result<Listener> listener = open_unix((folder->path() / "socket").string());
  if (listener) listener->folder_ = std::move(*folder);
  return listener;
}

Result<Listener> Listener::open_unix(const std::string& path) {
  const std::string address = "unix:" + path;
  const std::optional<sockaddr_un> name = unix_name(path);
  if (!name) return bad_address(address, "the path must have 1 to 107 bytes");
  Listener listener;
  listener.socket_ =
      FileDescriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const auto bind = [&] {
    return ::bind(listener.socket_.get(), reinterpret_cast<const sockaddr*>(&*name), sizeof(*name));
  };
  int failed = bind();
  if (failed != 0 && errno == EADDRINUSE) {
    // Never remove a user's file: it refuses a connection like a stale socket.
    if (const std::string other = other_than_socket(path); !other.empty()) {
      return bad_address(address, "is " + other + ", not a socket");
    }
    if (!is_stale(*name)) {
      return Error{ErrorCode::kConflict, "listen = '" + address + "': is in use"};
    }
    ::unlink(path.c_str());
    failed = bind();
  }
  if (failed != 0) return bad_address(address, system_message(errno));
  listener.path_ = path;
  if (::listen(listener.socket_.get(), 1) != 0) {
    return Error{ErrorCode::kIo, "listen = '" + address + "': " + system_message(errno)};
  }
  listener.address_ = address;
  return listener;
}

Result<Listener> Listener::open_tcp(const std::string& host, const std::string& port) {
  const std::string address = "tcp:" + host + ":" + port;
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  if (const int failure = ::getaddrinfo(host.c_str(), port.c_str(), &hints, &found); failure != 0) {
    return bad_address(address, ::gai_strerror(failure));
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> keep(found, ::freeaddrinfo);
  Listener listener;
  listener.socket_ = FileDescriptor(
      ::socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, found->ai_protocol));
  const int on = 1;
  ::setsockopt(listener.socket_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  if (::bind(listener.socket_.get(), found->ai_addr, found->ai_addrlen) != 0 ||
      ::listen(listener.socket_.get(), 1) != 0) {
    if (errno == EADDRINUSE) {
      return Error{ErrorCode::kConflict, "listen = '" + address + "': is in use"};
    }
    return bad_address(address, system_message(errno));
  }
  listener.address_ = "tcp:" + host + ":" + std::to_string(port_of(listener.socket_.get()));
  return listener;
}

Result<std::optional<Peer>> Listener::accept(std::chrono::milliseconds patience) {
  pollfd ready{socket_.get(), POLLIN, 0};
  if (::poll(&ready, 1, static_cast<int>(patience.count())) <= 0) return std::optional<Peer>{};
  Peer peer;
  peer.socket =
      FileDescriptor(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (!peer.socket.open()) {
    if (errno == EAGAIN || errno == ECONNABORTED || errno == EINTR) return std::optional<Peer>{};
    return Error{ErrorCode::kIo, address_ + ": accept: " + system_message(errno)};
  }
  if (path_.empty()) {
    const int on = 1;
    ::setsockopt(peer.socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    return std::optional<Peer>(std::move(peer));
  }
  ucred credentials{};
  socklen_t size = sizeof(credentials);
  if (::getsockopt(peer.socket.get(), SOL_SOCKET, SO_PEERCRED, &credentials, &size) != 0 ||
      credentials.uid != ::geteuid()) {
    return std::optional<Peer>{};
  }
  peer.local = true;
  peer.pid = credentials.pid;
  return std::optional<Peer>(std::move(peer));
}

}  // namespace overfly::process
