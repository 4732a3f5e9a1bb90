// What all connections of one server share.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>

#include "server/engine/run_manager.hpp"
#include "server/engine/view_service.hpp"
#include "server/net/allowed_hosts.hpp"
#include "server/net/rest_router.hpp"
#include "server/net/server.hpp"
#include "server/net/session_registry.hpp"
#include "server/net/static_files.hpp"
#include "server/net/token_gate.hpp"

namespace overfly::net {

/// Lets other threads call into the server's event loop only while there is one.
class CallbackGate {
 public:
  template <typename Action>
  void run(Action action) {
    const std::lock_guard lock(mutex_);
    if (open_) action();
  }
  /// No action runs after this returns.
  void close() {
    const std::lock_guard lock(mutex_);
    open_ = false;
  }

 private:
  std::mutex mutex_;
  bool open_ = true;
};

struct ServerContext {
  ServerContext(const ServerOptions& server_options,
                engine::RunManager& run_manager,
                engine::ViewService& view_service)
      : options(server_options),
        runs(run_manager),
        views(view_service),
        files(server_options.web_folder),
        token_gate(server_options.token),
        allowed_hosts(server_options.allowed_hosts),
        connections(server_options.limits.connections) {}

  void log(const std::string& level, const std::string& text) const {
    if (options.log) options.log(level, text);
  }

  const ServerOptions options;
  engine::RunManager& runs;
  engine::ViewService& views;
  RestRouter router;
  StaticFiles files;
  const TokenGate token_gate;
  const AllowedHosts allowed_hosts;
  CallbackGate gate;
  SessionRegistry sessions;
  /// Runs what may take long (reading a run from disk) on a thread that serves no connection.
  std::function<void(std::function<void()>)> offload;
  std::atomic<std::uint64_t> next_client{1};  ///< numbers clients of the view service
  ConnectionTable connections;
};

}  // namespace overfly::net
