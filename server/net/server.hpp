// The web server: REST, WebSocket and the dashboard's files.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "server/net/server_options.hpp"
#include "server/runs/run_manager.hpp"
#include "server/views/view_service.hpp"

namespace overfly::net {

class Server {
 public:
  /// Binds and starts to serve: connections on one thread, slow work on others.
  /// Errors: kIo with address, port and the system's reason; kNotFound without the web folder;
  /// kInternal if the system cannot start a thread; kInvalidArgument for an invalid address, token
  /// or allowed host, for an empty token if other machines can reach the server, and for a viewers'
  /// token that equals the operators'.
  static Result<std::unique_ptr<Server>> start(const ServerOptions& options,
                                               server::RunManager& runs,
                                               server::ViewService& views);
  ~Server();  ///< closes every viewer (close code 1001) and joins

  [[nodiscard]] std::uint16_t port() const;
  /// Address of the dashboard, with the token: only for the user who started the server.
  [[nodiscard]] std::string url() const;
  /// The same with the viewers' token; empty if there is none.
  [[nodiscard]] std::string viewer_url() const;

 private:
  Server();
  [[nodiscard]] std::string url_with(const std::string& token) const;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace overfly::net
