// Listens for estimators on "unix:PATH" or "tcp:HOST:PORT".
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "core/outside/file_descriptor.hpp"
#include "core/result.hpp"
#include "vo_bridges/process/child/private_folder.hpp"

namespace overfly::process {

/// A connected peer.
struct Peer {
  FileDescriptor socket;
  bool local = false;  ///< connected by a Unix socket: descriptors can be passed
  int pid = 0;         ///< 0 = unknown
};

/// A listening socket. Removes what it created in the file system on destruction.
class Listener {
 public:
  /// Errors: kInvalidArgument for an address of another form, an address of another machine, or a
  /// path to something other than a socket; kConflict if the address is in use; kIo.
  static Result<Listener> open(const std::string& address);
  /// Opens a Unix socket in a new folder that only this user can access. Errors: kIo.
  static Result<Listener> open_private();

  Listener(Listener&& other) noexcept;
  Listener& operator=(Listener&&) = delete;
  ~Listener();

  /// The address in the form of OVERFLY_VO_ADDRESS, with the actual port if 0 was requested.
  [[nodiscard]] const std::string& address() const { return address_; }
  /// The next connection within `patience`; empty if there was none. A connection of another user
  /// by a Unix socket is rejected. Errors: kIo.
  [[nodiscard]] Result<std::optional<Peer>> accept(std::chrono::milliseconds patience);

 private:
  Listener() = default;
  static Result<Listener> open_unix(const std::string& path);
  static Result<Listener> open_tcp(const std::string& host, const std::string& port);

  FileDescriptor socket_;
  std::string address_;
  std::optional<PrivateFolder> folder_;  // created for the socket, removed after it
  std::filesystem::path path_;           // of a Unix socket
};

}  // namespace overfly::process
