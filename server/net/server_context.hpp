// State shared by all connections of one server.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "core/barrier.hpp"
#include "server/calibration/session/calibration_desk.hpp"
#include "server/experiments/service/sweep_service.hpp"
#include "server/experiments/studies/study_service.hpp"
#include "server/logs/log_library.hpp"
#include "server/maps/map_service.hpp"
#include "server/net/http/allowed_hosts.hpp"
#include "server/net/http/rest_router.hpp"
#include "server/net/http/static_files.hpp"
#include "server/net/http/token_gate.hpp"
#include "server/net/reading_threads.hpp"
#include "server/net/rest/rest_api.hpp"
#include "server/net/server_options.hpp"
#include "server/net/session_registry.hpp"
#include "server/runs/run_manager.hpp"
#include "server/timing/thread_priority.hpp"
#include "server/trajectories/trajectory_library.hpp"
#include "server/views/view_service.hpp"

namespace overfly::net {

/// Lets other threads call into the server's event loop only while it exists.
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
                server::RunManager& run_manager,
                server::ViewService& view_service)
      : options(server_options),
        runs(run_manager),
        views(view_service),
        router([this](const std::string& what) { log("error", what); }),
        files(server_options.web_folder),
        token_gate(server_options.token, server_options.viewer_token),
        allowed_hosts(server_options.allowed_hosts),
        logs(
            [this] {
              server::DataFolders data = runs.data_folders();
              return server::ServedFolders{{}, std::move(data.folders), std::move(data.sources)};
            },
            server_options.uploads_folder,
            server_options.limits.uploads),
        trajectories(logs, [this](const std::string& id) { return runs.folder(id); }),
        calibrations(calibration_options()),
        sweeps(run_manager, sweep_options()),
        studies(run_manager, study_options()),
        maps(run_manager),
        connections(server_options.limits.connections) {}

  [[nodiscard]] server::DeskOptions calibration_options() {
    server::DeskOptions desk;
    desk.folders = [this] { return logs.folders(); };
    desk.scenario_camera = [this](const std::string& scenario, const std::string& camera) {
      return scenario_camera(runs, scenario, camera);
    };
    desk.cameras = options.cameras;
    const bool keeps = !options.uploads_folder.empty() && options.limits.uploads.quota_bytes > 0;
    if (keeps) desk.store = options.uploads_folder / server::kCalibrationsFolder;
    desk.begin_thread = [] { server::lower_thread(server::ThreadPriority::kBelowFlights); };
    return desk;
  }

  [[nodiscard]] server::experiments::SweepServiceOptions sweep_options() {
    server::experiments::SweepServiceOptions sweep;
    sweep.program = options.program;
    sweep.frame_cache_gib = options.frame_cache_gib;
    sweep.begin_thread = [] { server::lower_thread(server::ThreadPriority::kBelowFlights); };
    sweep.log = [this](const std::string& level, const std::string& text) {
      log(level.c_str(), text);
    };
    return sweep;
  }

  [[nodiscard]] server::experiments::StudyServiceOptions study_options() {
    server::experiments::StudyServiceOptions study;
    study.program = options.program;
    study.begin_thread = [] { server::lower_thread(server::ThreadPriority::kBelowFlights); };
    study.log = [this](const std::string& level, const std::string& text) {
      log(level.c_str(), text);
    };
    return study;
  }

  /// Never throws, since it is called from exception handlers.
  void log(const char* level, const std::string& text) const noexcept {
    (void)contained(
        [&] {
          if (options.log) options.log(level, text);
        },
        [](const char*) {});
  }

  /// Runs an action of another thread for a connection while there is an event loop. If it throws,
  /// it is retried for a while, because a client waits for the result. Never throws, since the
  /// thread belongs to the server.
  template <typename Action>
  void deliver(const Action& action) noexcept {
    constexpr int kTries = 100;
    constexpr std::chrono::milliseconds kPause{10};
    const auto ignore = [](const char*) {};
    for (int i = 0; i < kTries; ++i) {
      if (contained([&] { gate.run(action); }, ignore)) return;
      std::this_thread::sleep_for(kPause);
    }
    log("error", "an answer was lost: out of memory");
  }

  const ServerOptions options;
  server::RunManager& runs;
  server::ViewService& views;
  RestRouter router;
  StaticFiles files;
  const TokenGate token_gate;
  const AllowedHosts allowed_hosts;
  CallbackGate gate;
  SessionRegistry sessions;
  /// Runs slow work (reading a run from disk) on a thread that serves no connection.
  std::function<void(std::function<void()>)> offload;
  server::LogLibrary logs;
  server::TrajectoryLibrary trajectories;
  server::CalibrationDesk calibrations;
  server::experiments::SweepService sweeps;
  server::experiments::StudyService studies;
  /// Reads flight logs, which can take minutes, without keeping other requests waiting.
  ReadingThreads readers{[this](const std::string& what) { log("error", what); }};
  server::MapService maps;
  /// Draws maps and reads the ground: a log that takes minutes does not keep them waiting.
  ReadingThreads drawers{[this](const std::string& what) { log("error", what); }};
  std::atomic<std::uint64_t> next_client{1};  ///< next client number for the view service
  ConnectionTable connections;
};

}  // namespace overfly::net
