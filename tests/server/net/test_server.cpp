#include "tests/server/net/test_server.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "renderer/renderer.hpp"
#include "server/record/run_info.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json scenario(const terrain::WorldSpec& world, double duration_s, const std::string& pacing) {
  return {
      {"format_version", 1},
      {"title", "A test flight"},
      {"world",
       {{"imagery",
         json::array({{{"file", world.imagery.front().file.string()}, {"attribution", "test"}}})},
        {"ground_height_m", 200}}},
      {"flight", {{"course", {{"airspeed_m_s", 25}, {"height_agl_m", 60}}}}},
      {"duration_s", duration_s},
      {"camera", {{"width_px", 64}, {"height_px", 48}, {"rate_hz", 31}}},
      {"estimators", json::array({{{"name", "perfect"}, {"type", "perfect"}}})},
      {"pacing", pacing}};
}

void require(bool condition, const std::string& message) {
  if (!condition) throw std::runtime_error(message);
}

}  // namespace

TestServer::TestServer(const net::ServerLimits& limits, const std::string& token)
    : TestServer([&] {
        net::ServerOptions options;
        options.limits = limits;
        options.token = token;
        options.program = "/bin/false";  // Sweeps must not fly this program of tests.
        return options;
      }()) {}

TestServer::TestServer(net::ServerOptions server_options, server::RunManagerOptions options) {
  const fs::path scenarios = folder() / "scenarios";
  const fs::path web = folder() / "web";
  const fs::path world_folder = folder() / "world";
  const fs::path logs = folder() / "logs";
  const fs::path uploads = folder() / "uploads";
  for (const fs::path& path : {scenarios, web, world_folder, logs}) fs::create_directories(path);
  SyntheticWorldOptions small;
  small.size_m = 200.0;
  small.relief_m = 0.0;
  const terrain::WorldSpec world = write_synthetic_world(world_folder, small);
  json tiny = scenario(world, 2.0, "lockstep");
  tiny["recording"] = {{"frames", true}};
  json broken = tiny;
  broken["camera"]["width_px"] = 3;
  write_text(scenarios / "tiny.json", tiny.dump());
  write_text(scenarios / "slow.json", scenario(world, 60.0, "real_time").dump());
  write_text(scenarios / "broken.json", broken.dump());
  write_text(web / "index.html", "<title>Overfly</title>");

  options.runs_folder = folder() / "runs";
  options.scenarios_folder = scenarios;
  options.saved_scenarios_folder = folder() / "saved";
  options.sweeps_folder = folder() / "sweeps";
  options.studies_folder = folder() / "studies";
  options.data_folders = {world_folder, logs, uploads};
  server_options.uploads_folder = uploads;
  options.renderer_factory = [](std::shared_ptr<const terrain::TileSource> tiles)
      -> Result<std::unique_ptr<renderer::Renderer>> {
    return renderer::create_noop_renderer(std::move(tiles));
  };
  auto runs = server::RunManager::create(options);
  require(runs.ok(), runs.ok() ? "" : runs.error().message);
  runs_ = std::move(*runs);
  views_ = std::make_unique<server::ViewService>(*runs_);
  if (server_options.address != "127.0.0.1") server_options.token = std::string(32, 't');
  token_ = server_options.token;
  server_options.port = 0;
  server_options.web_folder = web;
  server_options.log = [this](const std::string& /*level*/, const std::string& text) {
    const std::lock_guard lock(log_mutex_);
    log_.push_back(text);
    logged_.notify_all();
  };
  auto server = net::Server::start(server_options, *runs_, *views_);
  require(server.ok(), server.ok() ? "" : server.error().message);
  server_ = std::move(*server);
}

Headers TestServer::with_token(Headers headers) const {
  if (!token_.empty()) headers["Authorization"] = "Bearer " + token_;
  return headers;
}

std::string TestServer::start(const std::string& scenario_name) {
  const auto info = runs_->start(scenario_name, {});
  require(info.ok(), info.ok() ? "" : info.error().message);
  return info->id;
}

std::string TestServer::fly(const std::string& scenario_name) {
  std::string id = start(scenario_name);
  wait_for_end(id);
  return id;
}

void TestServer::wait_for_log(const std::string& part) {
  std::unique_lock lock(log_mutex_);
  const bool seen = logged_.wait_for(lock, std::chrono::seconds(30), [&] {
    return std::any_of(log_.begin(), log_.end(), [&](const std::string& line) {
      return line.find(part) != std::string::npos;
    });
  });
  require(seen, "nothing logged about: " + part);
}

std::string TestServer::log() {
  const std::lock_guard lock(log_mutex_);
  std::string lines;
  for (const std::string& line : log_) lines += line + "\n";
  return lines;
}

void TestServer::wait_for_end(const std::string& id) {
  const auto timeline = runs_->timeline(id);
  require(timeline.ok(), "no timeline");
  std::uint64_t revision = (*timeline)->revision();
  for (;;) {
    const server::RunStatus status = (*timeline)->info().status;
    if (status != server::RunStatus::kQueued && status != server::RunStatus::kRunning) return;
    const std::uint64_t next = (*timeline)->wait_for_change(revision, 30'000);
    require(next != revision, "the run stands still for 30 s");
    revision = next;
  }
}

}  // namespace overfly::testing
