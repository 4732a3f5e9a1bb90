// The list of 1000 runs, from memory and as REST gives it, and one run of it.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "server/net/rest/rest_api.hpp"
#include "server/record/run_folder.hpp"
#include "server/runs/run_manager.hpp"
#include "tests/support/support.hpp"

namespace overfly {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kRuns = 1000;

std::string run_name(int i) { return "20260101-000000-course-" + std::to_string(100000 + i); }

json manifest_of(int i) {
  return {{"format_version", engine::kRunFormatVersion},
          {"status", i % 10 == 0 ? "failed" : "completed"},
          {"scenario", "course"},
          {"title", "The course over the built-in airfield, number " + std::to_string(i)},
          {"error", nullptr},
          {"duration_ns", 25'000'000'000},
          {"frames", 776},
          {"frames_total", 776},
          {"pacing", "lockstep"},
          {"estimators", {{{"name", "feature"}, {"type", "feature"}, {"camera", "camera0"}}}},
          {"cameras", {{{"name", "camera0"}}}},
          {"world", {{"attribution", "Imagery of a place by those who took it"}}}};
}

/// A manager over a folder of many runs, which live as long as the program.
engine::RunManager& manager() {
  static const testing::TemporaryFolder folder;
  static const std::unique_ptr<engine::RunManager> runs = [] {
    fs::create_directories(folder.path() / "scenarios");
    for (int i = 0; i < kRuns; ++i) {
      const fs::path run = folder.path() / "runs" / run_name(i);
      fs::create_directories(run);
      testing::write_text(engine::created_file(run),
                          json{{"created_utc", engine::utc_text(1'000'000'000LL * i)}}.dump(2));
      testing::write_text(engine::manifest_file(run), manifest_of(i).dump(2));
    }
    engine::RunManagerOptions options;
    options.runs_folder = folder.path() / "runs";
    options.scenarios_folder = folder.path() / "scenarios";
    auto made = engine::RunManager::create(options);
    if (!made) {
      std::cerr << made.error().message << "\n";
      std::exit(1);
    }
    return std::move(*made);
  }();
  return *runs;
}

void list_from_memory(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(manager().runs().size());
}
BENCHMARK(list_from_memory)->Unit(benchmark::kMicrosecond);

void one_run(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(manager().run(run_name(kRuns / 2)).ok());
}
BENCHMARK(one_run)->Unit(benchmark::kMicrosecond);

void ask(benchmark::State& state, const std::string& target) {
  net::RestRouter router;
  net::add_run_routes(&router, &manager());
  net::HttpRequest request;
  request.method = "GET";
  request.target = target;
  std::size_t bytes = 0;
  for (auto _ : state) {
    router.handle(request,
                  [&](const net::HttpResponse& response) { bytes = response.body.size(); });
  }
  state.counters["body_bytes"] = static_cast<double>(bytes);
}
void list_by_rest(benchmark::State& state) { ask(state, "/api/v1/runs"); }
BENCHMARK(list_by_rest)->Unit(benchmark::kMicrosecond);
void one_run_by_rest(benchmark::State& state) { ask(state, "/api/v1/runs/" + run_name(3)); }
BENCHMARK(one_run_by_rest)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace overfly

BENCHMARK_MAIN();
