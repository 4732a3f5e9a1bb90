#include "server/app/commands/bench/bench_fly.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>

#include "server/app/commands/bench/bench_folder.hpp"
#include "server/app/stop_signal.hpp"
#include "terrain/synthesize_strip.hpp"
#include "terrain/world.hpp"

namespace overfly::app {
namespace {

using Json = nlohmann::json;

std::string hex(std::uint64_t number) {
  std::ostringstream text;
  text << std::hex << std::setw(16) << std::setfill('0') << number;
  return text.str();
}

Json endurance_json(const renderer::EnduranceOptions& options,
                    const renderer::EnduranceReport& report) {
  const std::int64_t loaded = report.tiles.read_ahead + report.tiles.read_on_demand;
  return {{"renderer", report.renderer.backend},
          {"device", report.renderer.device},
          {"length_m", options.length_m},
          {"speed_m_s", options.speed_m_s},
          {"height_m", options.height_m},
          {"rate_hz", options.rate_hz},
          {"width_px", options.width_px},
          {"height_px", options.height_px},
          {"warm_up_s", options.warm_up_s},
          {"tile_cache_bytes", options.tile_cache_bytes},
          {"frames", report.frames},
          {"frames_counted", report.frames_counted},
          {"cpu_ms",
           {{"median", report.cpu_ms_median},
            {"p99", report.cpu_ms_p99},
            {"p99_9", report.cpu_ms_p999},
            {"max", report.cpu_ms_max}}},
          {"drawing_thread_cpu_ms",
           {{"median", report.thread_cpu_ms_median}, {"p99_9", report.thread_cpu_ms_p999}}},
          {"p99_9_per_median", report.cpu_ms_p999 / report.cpu_ms_median},
          {"wall_ms", {{"median", report.wall_ms_median}, {"max", report.wall_ms_max}}},
          {"resident_mb",
           {{"median_by_tenth", report.resident_mb_by_tenth}, {"peak", report.resident_peak_mb}}},
          {"tiles",
           {{"peak_bytes", report.tiles_peak_bytes},
            {"loaded", loaded},
            {"read_ahead", report.tiles.read_ahead},
            {"read_on_demand", report.tiles.read_on_demand},
            {"ahead_cpu_ms_per_tile",
             1e3 * report.tiles.ahead_cpu_s /
                 static_cast<double>(std::max<std::int64_t>(report.tiles.read_ahead, 1))},
            {"evicted", report.tiles.let_go},
            {"late", report.late_tiles}}},
          {"digest", hex(report.digest)}};
}

}  // namespace

Result<Json> bench_long_flight(const renderer::EnduranceOptions& options,
                               ProgressDisplay& display) {
  Result<BenchFolder> folder = BenchFolder::create();
  if (!folder) return folder.error();
  terrain::StripOptions strip;
  // synthesize_strip requires at least 2 km.
  strip.length_m = std::max(options.length_m + 4.0 * options.height_m, 2000.0);
  const auto target = folder->path() / "strip";
  const auto keep_going = [&](const char* what) {
    return [&display, what](double share) {
      display.show(share, what);
      return !catch_stop_signals().load();
    };
  };
  const Status made = terrain::synthesize_strip(target, strip, keep_going("making the strip"));
  if (!made) return made.error();
  const auto spec = terrain::read_world_manifest(target / "world.json");
  if (!spec) return spec.error();
  const auto world = terrain::open_world(*spec);
  if (!world) return world.error();
  const auto report = renderer::fly_endurance(world->tiles, options, keep_going("flying"));
  if (!report) return report.error();
  return endurance_json(options, *report);
}

void print_long_flight(const Json& result) {
  const auto number = [&](const char* pointer) {
    return result.at(Json::json_pointer(pointer)).get<double>();
  };
  const auto whole = [&](const char* pointer) {
    return result.at(Json::json_pointer(pointer)).get<std::int64_t>();
  };
  std::cout << std::fixed << std::setprecision(2)  //
            << "flight                  " << number("/length_m") / 1000.0 << " km at "
            << number("/speed_m_s") << " m/s, " << whole("/frames") << " frames of "
            << whole("/width_px") << "x" << whole("/height_px") << " at " << number("/rate_hz")
            << " Hz\n"
            << "rendered by             " << result.at("renderer").get<std::string>() << ", "
            << result.at("device").get<std::string>() << "\n"
            << "CPU time a frame        median " << number("/cpu_ms/median") << " ms, p99 "
            << number("/cpu_ms/p99") << " ms, p99.9 " << number("/cpu_ms/p99_9") << " ms ("
            << number("/p99_9_per_median") << " medians), max " << number("/cpu_ms/max")
            << " ms, over " << whole("/frames_counted") << " frames\n"
            << "  the drawing thread's  median " << number("/drawing_thread_cpu_ms/median")
            << " ms, p99.9 " << number("/drawing_thread_cpu_ms/p99_9") << " ms\n"
            << "resident memory         ";
  for (const Json& tenth : result.at("resident_mb").at("median_by_tenth")) {
    std::cout << std::llround(tenth.get<double>()) << " ";
  }
  std::cout << "MB (medians of the flight's tenths), peak " << number("/resident_mb/peak")
            << " MB\n"
            << "tiles                   " << whole("/tiles/loaded") << " loaded ("
            << whole("/tiles/read_on_demand") << " on demand; read ahead at "
            << number("/tiles/ahead_cpu_ms_per_tile") << " ms of CPU each), "
            << whole("/tiles/evicted") << " evicted, " << whole("/tiles/late") << " late, at most "
            << number("/tiles/peak_bytes") / 1e6 << " MB kept\n"
            << "digest of the images    " << result.at("digest").get<std::string>() << "\n";
}

}  // namespace overfly::app
