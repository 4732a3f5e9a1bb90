// Where an estimator connects to: "unix:PATH" or "tcp:HOST:PORT".
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "vo_bridges/process/file_descriptor.hpp"
#include "vo_bridges/process/private_folder.hpp"

namespace overfly::process {

/// One who has connected.
struct Peer {
  FileDescriptor socket;
  bool local = false;  ///< by a Unix socket: descriptors can be passed
  int pid = 0;         ///< 0 = not known
};

/// A listening socket; what it made in the file system is gone with it.
class Listener {
 public:
  /// Errors: kInvalidArgument for an address of neither form, that is not this machine's, or where
  /// something other than a socket stands;
  /// kConflict for one where somebody listens already; kIo.
  static Result<Listener> open(const std::string& address);
  /// A Unix socket in a new folder that only this user can enter. Errors: kIo.
  static Result<Listener> open_private();

  Listener(Listener&& other) noexcept;
  Listener& operator=(Listener&&) = delete;
  ~Listener();

  /// As OVERFLY_VO_ADDRESS says it; with the true port where 0 was asked for.
  [[nodiscard]] const std::string& address() const { return address_; }
  /// The next to connect within `patience`; empty if nobody did. Somebody of another user, by a
  /// Unix socket, is turned away. Errors: kIo.
  [[nodiscard]] Result<std::optional<Peer>> accept(std::chrono::milliseconds patience);

 private:
  Listener() = default;
  static Result<Listener> open_unix(const std::string& path);
  static Result<Listener> open_tcp(const std::string& host, const std::string& port);

  FileDescriptor socket_;
  std::string address_;
  std::optional<PrivateFolder> folder_;  // made for the socket, removed after it
  std::filesystem::path path_;           // of a Unix socket
};

}  // namespace overfly::process
