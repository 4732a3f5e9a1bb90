// The web server: REST, WebSocket and the dashboard's files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/engine/run_manager.hpp"
#include "server/engine/view_service.hpp"
#include "server/net/connection_table.hpp"

namespace overfly::net {

/// What one client may ask of the server.
struct ServerLimits {
  std::size_t max_body_bytes = std::size_t{1} << 20U;      ///< of a request; beyond: 413
  std::size_t max_header_bytes = std::size_t{16} << 10U;   ///< of a request; beyond: 431
  std::size_t max_message_bytes = std::size_t{64} << 10U;  ///< WebSocket; beyond: close code 1009
  std::size_t max_unsent_bytes = std::size_t{16} << 20U;   ///< WebSocket; beyond: close code 4000
  std::int64_t max_stall_ms = 15'000;  ///< WebSocket: one message on its way; beyond: 4000
  std::int64_t header_ms = 10'000;     ///< a new connection's first request, up to its header
  std::int64_t idle_ms = 30'000;       ///< connections that say nothing (WebSockets are pinged)
  ConnectionLimits connections;
  /// Kernel buffer of a WebSocket: pictures in it are old ones, so it stays small.
  int send_buffer_bytes = 256 << 10;
};

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< loopback unless told otherwise
  std::uint16_t port = 8480;          ///< 0 = any free port
  /// What every request must show (access_token.hpp); empty = nothing, on a loopback address only.
  std::string token;
  /// Host names and addresses by which clients may ask, besides those of AllowedHosts.
  std::vector<std::string> allowed_hosts;
  std::filesystem::path web_folder;  ///< built dashboard; empty = REST and WebSocket only
  ServerLimits limits;
  /// One line for each thing worth telling: (level, text).
  std::function<void(const std::string&, const std::string&)> log;
};

class Server {
 public:
  /// Binds and starts to serve: connections on one thread, what may take long on others.
  /// Errors: kIo with address, port and the system's reason; kNotFound without the web folder;
  /// kInternal when the system starts no thread; kInvalidArgument for a bad address, token or
  /// allowed host, and for none where others can reach the server.
  static Result<std::unique_ptr<Server>> start(const ServerOptions& options,
                                               engine::RunManager& runs,
                                               engine::ViewService& views);
  ~Server();  ///< tells every viewer that it goes (close code 1001) and joins

  [[nodiscard]] std::uint16_t port() const;
  /// Address of the dashboard, with the token: for the one who started the server alone.
  [[nodiscard]] std::string url() const;

 private:
  Server();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace overfly::net
