// A whole server on a free loopback port, over a small world, with a renderer that needs no GPU.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/net/server.hpp"
#include "server/runs/run_manager.hpp"
#include "server/views/view_service.hpp"
#include "tests/server/net/test_client.hpp"
#include "tests/support/support.hpp"

namespace overfly::testing {

/// Scenarios: "tiny" (2 s in lockstep, estimator "perfect", frames recorded), "slow" (60 s in
/// real time, the same estimator) and "broken" (a field at fault). Flight logs: folder() / "logs",
/// empty, and uploads in folder() / "uploads"; saved scenarios in folder() / "saved",
/// sweeps in folder() / "sweeps" and studies in folder() / "studies", which are absent.
class TestServer {
 public:
  /// @param token  that clients must show; empty = none
  explicit TestServer(const net::ServerLimits& limits = {}, const std::string& token = "");
  /// Takes all of the options but port, dashboard and log. Off loopback it has a token.
  /// @param runs  its folders and its renderer are the test's own
  explicit TestServer(net::ServerOptions options, server::RunManagerOptions runs = {});

  [[nodiscard]] std::uint16_t port() const { return server_->port(); }
  [[nodiscard]] server::RunManager& runs() { return *runs_; }
  [[nodiscard]] server::ViewService& views() { return *views_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  [[nodiscard]] static std::string body_of(const std::string& scenario) {
    return nlohmann::json{{"scenario", scenario}}.dump();
  }
  /// Starts a run and returns its id. Throws when it cannot.
  std::string start(const std::string& scenario);
  /// Starts a run and waits for its end.
  std::string fly(const std::string& scenario);
  void wait_for_end(const std::string& id);
  /// Waits until the server has logged a line with `part` in it. Throws after 30 s.
  void wait_for_log(const std::string& part);
  /// Every line logged so far.
  [[nodiscard]] std::string log();
  [[nodiscard]] std::string url() const { return server_->url(); }
  /// The headers, and the one that shows the server's token.
  [[nodiscard]] Headers with_token(Headers headers = {}) const;

 private:
  TemporaryFolder folder_;
  std::mutex log_mutex_;
  std::condition_variable logged_;
  std::vector<std::string> log_;
  std::unique_ptr<server::RunManager> runs_;
  std::unique_ptr<server::ViewService> views_;
  std::string token_;
  std::unique_ptr<net::Server> server_;
};

}  // namespace overfly::testing
