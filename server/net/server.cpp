#include "server/net/server.hpp"

#include <boost/asio/post.hpp>
#include <chrono>
#include <system_error>
#include <utility>

#include "server/net/http/access_token.hpp"
#include "server/net/http/allowed_hosts.hpp"
#include "server/net/listener.hpp"
#include "server/net/loop_threads.hpp"
#include "server/net/rest/rest_api.hpp"
#include "server/net/server_context.hpp"
#include "server/timing/thread_priority.hpp"

namespace overfly::net {

namespace {

/// Each reads at most one run from disk at a time, while the others answer requests.
constexpr int kWorkers = 4;
/// Time for viewers to answer the close frame at shutdown.
constexpr std::chrono::seconds kFarewell{2};

Status check_options(const ServerOptions& options) {
  std::error_code error;
  if (!options.web_folder.empty() &&
      !std::filesystem::is_regular_file(options.web_folder / "index.html", error)) {
    return Error{ErrorCode::kNotFound,
                 "the dashboard's folder " + options.web_folder.string() + " has no index.html"};
  }
  for (const std::string& name : options.allowed_hosts) {
    if (Status status = AllowedHosts::check_name(name); !status) return status;
  }
  if (!options.viewer_token.empty()) {
    if (options.token.empty() || options.token == options.viewer_token) {
      return Error{ErrorCode::kInvalidArgument,
                   "the viewers' token must differ from the operators', which is required then"};
    }
    if (Status status = check_token(options.viewer_token); !status) return status;
  }
  if (!options.token.empty()) return check_token(options.token);
  if (is_loopback_host(options.address)) return {};
  return Error{ErrorCode::kInvalidArgument,
               "address = " + options.address +
                   ": can be reached from other machines, so a token is required"};
}

}  // namespace

struct Server::Impl {
  void report(const std::string& what) const {
    if (context) context->log("error", what);
  }
  std::shared_ptr<ServerContext> context;
  LoopThreads connections{[this](const std::string& what) { report(what); }};
  LoopThreads workers{[this](const std::string& what) { report(what); }};
  std::uint16_t port = 0;
};

Server::Server() : impl_(std::make_unique<Impl>()) {}

Server::~Server() {
  if (impl_->context) {
    impl_->context->sweeps.request_stop();
    impl_->context->studies.request_stop();
    impl_->context->sessions.close_all(kFarewell);
    impl_->context->gate.close();
    impl_->context->readers.stop();
    impl_->context->drawers.stop();
    impl_->context->sweeps.stop();
    impl_->context->studies.stop();
  }
  impl_->workers.stop();
  impl_->connections.stop();
}

Result<std::unique_ptr<Server>> Server::start(const ServerOptions& options,
                                              server::RunManager& runs,
                                              server::ViewService& views) {
  if (const Status status = check_options(options); !status) return status.error();
  std::unique_ptr<Server> server(new Server());
  auto context = std::make_shared<ServerContext>(options, runs, views);
  add_service_routes(&context->router);
  add_run_routes(&context->router, &runs, &views);
  add_result_routes(&context->router, &runs);
  add_frame_routes(&context->router, &runs, &views);
  const ReadingRoutes readers{
      [raw = context.get()](std::function<void()> work, const ReadingThreads::Cancel& cancel) {
        return raw->readers.take(std::move(work), cancel);
      },
      [raw = context.get()](const std::string& what) { raw->log("error", what); }};
  add_scenario_routes(&context->router, &runs, readers);
  add_sensor_routes(&context->router, &runs, readers);
  const auto progress = std::make_shared<ProgressBoard>();
  const ReadingRoutes drawers{
      [raw = context.get()](std::function<void()> work, const ReadingThreads::Cancel& cancel) {
        return raw->drawers.take(std::move(work), cancel);
      },
      readers.report};
  add_world_routes(&context->router, {&context->maps, drawers, progress});
  add_mission_routes(&context->router, {&runs, &context->maps, drawers});
  add_progress_routes(&context->router, progress);
  add_log_routes(&context->router, {&context->logs, readers, progress});
  add_trajectory_routes(&context->router, &context->trajectories, readers);
  add_difference_routes(&context->router, &runs, readers);
  add_report_routes(&context->router, &runs, drawers);
  const SweepRoutes sweeps{&context->sweeps, runs.sweeps_folder(), readers, &views};
  add_sweep_routes(&context->router, sweeps);
  add_sweep_table_routes(&context->router, sweeps);
  add_sweep_start_routes(&context->router, sweeps);
  add_study_routes(&context->router, {&context->studies, readers, &views});
  add_calibration_session_routes(&context->router, &context->calibrations);
  add_calibration_routes(&context->router, &context->calibrations);
  context->offload = [workers = &server->impl_->workers](std::function<void()> work) {
    boost::asio::post(workers->loop(), std::move(work));
  };
  server->impl_->context = context;
  const auto port = listen(&server->impl_->connections.loop(), context);
  if (!port) return port.error();
  server->impl_->port = *port;
  if (const Status started = server->impl_->workers.start(kWorkers); !started) {
    return started.error();
  }
  const auto below_flights = [] { server::lower_thread(server::ThreadPriority::kBelowFlights); };
  for (ReadingThreads* threads : {&context->readers, &context->drawers}) {
    if (const Status started = threads->start(below_flights); !started) return started.error();
  }
  const Status started = server->impl_->connections.start(1, below_flights);
  if (!started) return started.error();
  return server;
}

std::uint16_t Server::port() const { return impl_->port; }

std::string Server::url() const { return url_with(impl_->context->options.token); }

std::string Server::viewer_url() const {
  const std::string& token = impl_->context->options.viewer_token;
  return token.empty() ? "" : url_with(token);
}

std::string Server::url_with(const std::string& token) const {
  const ServerOptions& options = impl_->context->options;
  std::string address = options.address;
  if (address == "0.0.0.0") address = "127.0.0.1";
  if (address == "::") address = "::1";
  const bool is_ipv6 = address.find(':') != std::string::npos;
  return "http://" + (is_ipv6 ? "[" + address + "]" : address) + ":" + std::to_string(impl_->port) +
         "/" + (token.empty() ? "" : "?token=" + token);
}

}  // namespace overfly::net
