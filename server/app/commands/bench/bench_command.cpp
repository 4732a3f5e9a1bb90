// overfly bench: measures the cost of rendering, encoding, tracking and reading logs on this
// machine.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/probes/bench_probe.hpp"
#include "server/app/commands/bench/bench_dynamics.hpp"
#include "server/app/commands/bench/bench_fly.hpp"
#include "server/app/commands/bench/bench_folder.hpp"
#include "server/app/commands/bench/bench_logs.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/progress.hpp"
#include "server/app/stop_signal.hpp"
#include "server/camera/truth.hpp"
#include "server/files/jpeg.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/run/run.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/worlds/world_cache.hpp"

namespace overfly::app {
namespace {

using Json = nlohmann::json;

struct BenchArguments {
  double flight_s = 10.0;
  int repetitions = 20;
  bool json = false;
  double fly_km = 0.0;  // 0 = the usual measurements
  int fly_cache_mib = 256;
  renderer::EnduranceOptions endurance;
};

Result<server::Scenario> bench_scenario(double flight_s) {
  return server::resolve_scenario({{"format_version", 1},
                                   {"name", "bench"},
                                   {"world", {{"builtin", {{"seed", 1}}}}},
                                   {"flight", {{"course", Json::object()}}},
                                   {"duration_s", flight_s},
                                   {"recording", {{"debug_hz", 0}}},
                                   {"estimators", {{{"name", "feature"}, {"type", "feature"}}}}},
                                  {},
                                  std::filesystem::current_path());
}

/// Camera poses distributed over the course: level flight and turns.
Result<std::vector<Pose>> course_poses(const server::Scenario& scenario,
                                       const terrain::World& world,
                                       int count) {
  const auto truth = server::create_truth(scenario, world);
  if (!truth) return truth.error();
  const std::int64_t end_ns = (*truth)->duration_ns().value_or(0);
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const auto state = (*truth)->state_at(end_ns * i / count);
    if (!state) return state.error();
    if (!*state) break;
    poses.push_back((*state)->T_world_body * Pose{R_body_camera_nadir(), Eigen::Vector3d::Zero()});
  }
  return poses;
}

Json json_of(const renderer::CallCost& cost) {
  return {{"cpu_ms", cost.cpu_ms}, {"wall_ms", cost.wall_ms}};
}

Result<Json> bench_drawing(const terrain::World& world,
                           const std::vector<Pose>& poses,
                           const BenchArguments& arguments) {
  const auto costs = renderer::measure_render_costs(
      world.tiles, poses, arguments.repetitions, arguments.endurance.device);
  if (!costs) return costs.error();
  return Json{{"quad", json_of(costs->quad)},
              {"camera_grey_1280x960", json_of(costs->camera_grey)},
              {"camera_rgb_1280x960", json_of(costs->camera_rgb)},
              {"depth_1280x960", json_of(costs->depth)},
              {"scene_960x720", json_of(costs->scene)},
              {"camera_per_quad", costs->camera_per_quad},
              {"raycast_per_quad", costs->raycast_per_quad},
              {"raycast_banked_per_quad", costs->raycast_banked_per_quad}};
}

/// Limits of the camera's frame rate, and the rate reached.
Result<Json> bench_rates(const terrain::World& world,
                         const std::vector<Pose>& poses,
                         const BenchArguments& arguments) {
  const int rounds = std::clamp(arguments.repetitions / 4, 1, 50);
  const auto costs =
      renderer::measure_rate_costs(world.tiles, poses, rounds, arguments.endurance.device);
  if (!costs) return costs.error();
  Json camera = Json::array();
  for (const auto& rate : costs->camera) {
    camera.push_back({{"in_flight", rate.in_flight}, {"per_s", rate.per_s}});
  }
  return Json{{"device", costs->renderer.device},
              {"device_note", costs->renderer.device_note},
              {"software", costs->renderer.software},
              {"memcpy_ms", costs->memcpy_ms},
              {"readback_ms", costs->readback_ms},
              {"readback_per_memcpy", costs->readback_per_memcpy},
              {"fill_per_s", costs->fill_per_s},
              {"copy_per_s", costs->copy_per_s},
              {"camera_grey_1280x960", std::move(camera)}};
}

void print_rates(const Json& rates) {
  const auto number = [&](const char* name) { return rates.at(name).get<double>(); };
  std::cout << "device                  " << rates.at("device").get<std::string>()
            << (rates.at("software").get<bool>() ? " (software)" : "") << "\n";
  const auto note = rates.at("device_note").get<std::string>();
  if (!note.empty()) std::cout << "                        " << note << "\n";
  std::cout << "readback 1280x960 grey  " << std::setw(8) << number("readback_ms") << " ms, memcpy "
            << number("memcpy_ms") << " ms: " << number("readback_per_memcpy") << " times\n"
            << "ceilings                " << std::setw(8) << number("fill_per_s")
            << " quads/s filled, " << number("copy_per_s") << " images/s copied\n";
  for (const Json& rate : rates.at("camera_grey_1280x960")) {
    std::cout << "camera, in flight: " << rate.at("in_flight").get<int>() << "    " << std::setw(8)
              << rate.at("per_s").get<double>() << " frames/s with readback\n";
  }
}

Result<Json> bench_encoding(const terrain::World& world, const Pose& T_world_camera, int times) {
  const auto renderer = renderer::create_egl_renderer(world.tiles);
  if (!renderer) return renderer.error();
  const auto camera =
      PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal);
  if (!camera) return camera.error();
  Json result = Json::object();
  for (const auto format : {renderer::PixelFormat::kGrey8, renderer::PixelFormat::kRgb8}) {
    const auto frame = (*renderer)->render_camera(*camera, T_world_camera, 0, format);
    if (!frame) return frame.error();
    std::size_t bytes = 0;
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < times; ++i) {
      const auto jpeg = server::encode_jpeg(frame->image, 75);
      if (!jpeg) return jpeg.error();
      bytes = jpeg->size();
    }
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - begin;
    const bool grey = format == renderer::PixelFormat::kGrey8;
    result[grey ? "jpeg75_grey_1280x960" : "jpeg75_rgb_1280x960"] = {
        {"wall_ms", elapsed.count() / times}, {"bytes", bytes}};
  }
  return result;
}

/// A lockstep flight with the native estimator, and the time spent in each stage.
Result<Json> bench_flight(const server::Scenario& scenario, server::WorldCache& worlds) {
  Result<BenchFolder> folder = BenchFolder::create();
  if (!folder) return folder.error();
  server::RunOptions options;
  options.folder = folder->path() / "run";
  options.worlds = &worlds;
  options.cancel = &catch_stop_signals();
  const auto run = server::run_scenario(scenario, options);
  if (!run) return run.error();
  if (run->info.status == server::RunStatus::kCancelled) {
    return Error{ErrorCode::kCancelled, "cancelled"};
  }
  const auto timings = server::read_json(server::timings_file(options.folder));
  if (!timings) return timings.error();
  const Json& estimator = timings->at("estimators").at("feature");
  return Json{{"flight_s", timings->at("flight_s")},
              {"wall_s", timings->at("loop_wall_s")},
              {"flight_s_per_wall_s", timings->at("flight_s_per_wall_s")},
              {"stages", timings->at("stages")},
              {"estimator_latency", estimator.at("latency")},
              {"estimator_stages", estimator.at("stages")}};
}

void print_table(const Json& result) {
  std::cout << std::fixed << std::setprecision(2);
  for (const auto& [name, cost] : result.at("drawing").items()) {
    if (!cost.is_object()) continue;
    std::cout << std::left << std::setw(24) << name << std::right << std::setw(8)
              << cost.at("wall_ms").get<double>() << " ms wall " << std::setw(8)
              << cost.at("cpu_ms").get<double>() << " ms CPU\n";
  }
  const auto per_quad = [&](const char* label, const char* name) {
    std::cout << std::left << std::setw(24) << label << std::right << std::setw(8)
              << result.at("drawing").at(name).get<double>() << " Q (CPU time)\n";
  };
  per_quad("camera frame / quad", "camera_per_quad");
  per_quad("ray-caster, level", "raycast_per_quad");
  per_quad("ray-caster, banked", "raycast_banked_per_quad");
  print_rates(result.at("rates"));
  for (const auto& [name, cost] : result.at("encoding").items()) {
    std::cout << std::left << std::setw(24) << name << std::right << std::setw(8)
              << cost.at("wall_ms").get<double>() << " ms wall " << std::setw(8)
              << cost.at("bytes").get<double>() / 1000.0 << " kB\n";
  }
  const Json& flight = result.at("flight");
  std::cout << "lockstep flight         " << std::setw(8)
            << flight.at("flight_s_per_wall_s").get<double>() << " s of flight per s\n";
  for (const char* kind : {"stages", "estimator_stages"}) {
    for (const auto& [name, stage] : flight.at(kind).items()) {
      if (!stage.contains("mean_ms")) continue;
      std::cout << "  " << std::left << std::setw(22) << name << std::right << std::setw(8)
                << stage.at("mean_ms").get<double>() << " ms mean " << std::setw(8)
                << stage.at("total_ms").get<double>() / 1000.0 << " s in all\n";
    }
  }
  const Json& dynamics = result.at("dynamics");
  std::cout << "flight model, " << std::setprecision(0) << dynamics.at("rate_hz").get<double>()
            << " Hz    " << std::setw(8) << dynamics.at("times_real_time").get<double>()
            << " times real time on one core\n";
  for (const auto& [name, mb_per_s] : result.at("logs").items()) {
    std::cout << "opening a log, " << std::left << std::setw(24) << name << std::right
              << std::setw(8) << mb_per_s.get<double>() << "\n";
  }
}

Result<Json> measure(const BenchArguments& arguments, ProgressDisplay& display) {
  const Result<server::Scenario> scenario = bench_scenario(arguments.flight_s);
  if (!scenario) return scenario.error();
  server::WorldCache worlds;
  const auto opened = worlds.get(*scenario, [&](double share) {
    display.show(share, "making the built-in world");
    return !catch_stop_signals().load();
  });
  if (!opened) return opened.error();
  const terrain::World& world = (*opened)->world;
  const auto poses = course_poses(*scenario, world, 12);
  if (!poses) return poses.error();
  display.note("drawing ...");
  Result<Json> drawing = bench_drawing(world, *poses, arguments);
  if (!drawing) return drawing.error();
  Result<Json> rates = bench_rates(world, *poses, arguments);
  if (!rates) return rates.error();
  display.note("encoding ...");
  Result<Json> encoding = bench_encoding(world, poses->front(), arguments.repetitions);
  if (!encoding) return encoding.error();
  display.note("flying ...");
  Result<Json> flight = bench_flight(*scenario, worlds);
  if (!flight) return flight.error();
  display.note("stepping the flight model ...");
  Result<Json> dynamics = bench_dynamics();
  if (!dynamics) return dynamics.error();
  display.note("reading flight logs ...");
  Result<Json> logs = bench_logs();
  if (!logs) return logs.error();
  return Json{{"drawing", std::move(*drawing)},
              {"rates", std::move(*rates)},
              {"encoding", std::move(*encoding)},
              {"flight", std::move(*flight)},
              {"dynamics", std::move(*dynamics)},
              {"logs", std::move(*logs)}};
}

int bench(BenchArguments& arguments) {
  (void)catch_stop_signals();
  const bool long_flight = arguments.fly_km > 0.0;
  arguments.endurance.length_m = 1000.0 * arguments.fly_km;
  arguments.endurance.tile_cache_bytes = static_cast<std::size_t>(arguments.fly_cache_mib) << 20U;
  Result<Json> result = Error{};
  {
    ProgressDisplay display(arguments.json);
    result =
        long_flight ? bench_long_flight(arguments.endurance, display) : measure(arguments, display);
  }
  if (!result) return report(result.error());
  if (arguments.json) {
    std::cout << result->dump(2) << "\n";
  } else if (long_flight) {
    print_long_flight(*result);
  } else {
    print_table(*result);
  }
  return kExitOk;
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<BenchArguments>();
  CLI::App* command = app.add_subcommand("bench", "Measure drawing, encoding and tracking here");
  command->add_option("--flight-s", arguments->flight_s, "Length of the measured flight [s]")
      ->check(CLI::Range(1.0, 200.0))
      ->capture_default_str();
  command->add_option("--repetitions", arguments->repetitions, "Repetitions for each image")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Print JSON");
  command->add_option("--device",
                      arguments->endurance.device,
                      "EGL device: an index, a PCI address or \"software\"");
  command
      ->add_option("--fly-km",
                   arguments->fly_km,
                   "Instead fly this distance [km] over a strip of 0.5 m/px in lockstep")
      ->check(CLI::Range(1.5, 390.0));
  command->add_option("--fly-hz", arguments->endurance.rate_hz, "Frames per second of that flight")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  command
      ->add_option("--fly-camera", arguments->endurance.camera_backend, "Renderer of that flight")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, renderer::CameraBackend>{
              {"auto", renderer::CameraBackend::kAuto},
              {"egl", renderer::CameraBackend::kEgl},
              {"raycast", renderer::CameraBackend::kRaycast}},
          CLI::ignore_case));
  command
      ->add_option("--fly-threads",
                   arguments->endurance.threads,
                   "Threads of the ray-caster; 0 = one per core")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  command->add_option("--fly-cache-mib", arguments->fly_cache_mib, "Tiles kept in memory [MiB]")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = bench(*arguments); });
}

}  // namespace overfly::app
