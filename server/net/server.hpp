// The web server: REST, WebSocket and the dashboard's files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "server/engine/run_manager.hpp"
#include "server/engine/view_service.hpp"

namespace overfly::net {

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< loopback unless told otherwise
  std::uint16_t port = 8480;          ///< 0 = any free port
  std::filesystem::path web_folder;   ///< built dashboard; empty = REST and WebSocket only
  int threads = 1;
  /// One line for each thing worth telling: (level, text).
  std::function<void(const std::string&, const std::string&)> log;
};

class Server {
 public:
  /// Binds and starts to serve on threads of its own.
  /// Errors: kIo with address, port and the system's reason; kNotFound without the web folder.
  static Result<std::unique_ptr<Server>> start(const ServerOptions& options,
                                               engine::RunManager& runs,
                                               engine::ViewService& views);
  ~Server();  ///< closes every connection and joins

  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] std::string url() const;

 private:
  Server();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace overfly::net
