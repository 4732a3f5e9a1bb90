// The list of 1000 runs, read for the first time, from memory and as REST gives it, and one run.
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
#include "server/record/run_manifest.hpp"
#include "server/runs/run_index.hpp"
#include "server/runs/run_manager.hpp"
#include "server/scoring/run_metrics_json.hpp"
#include "server/views/view_service.hpp"
#include "tests/support/support.hpp"

namespace overfly {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kRuns = 1000;

std::string run_name(int i) { return "20260101-000000-course-" + std::to_string(100000 + i); }

json manifest_of(int i) {
  server::RunManifest manifest;
  manifest.status = i % 10 == 0 ? server::RunStatus::kFailed : server::RunStatus::kCompleted;
  manifest.scenario = "course";
  manifest.title = "The course over the built-in airfield, number " + std::to_string(i);
  manifest.duration_ns = 25'000'000'000;
  manifest.frames = 776;
  manifest.frames_total = 776;
  manifest.pacing = "lockstep";
  server::RunManifest::Estimator& estimator = manifest.estimators.emplace_back();
  estimator.name = "feature";
  estimator.type = "feature";
  estimator.camera = "camera0";
  server::RunManifest::Camera& camera = manifest.cameras.emplace_back();
  camera.name = "camera0";
  camera.model = CameraModel(PinholeCamera{1280, 960, 700.0, 700.0, 639.5, 479.5});
  manifest.world.emplace().attribution = "Imagery of a place by those who took it";
  return server::json_from(manifest);
}

/// One estimator under every alignment: 17 kB.
json metrics_document() {
  server::RunMetrics metrics;
  metrics.flight = {25.0, 625.0};
  evaluation::Score& score = metrics.estimators["feature"].score;
  score.outcome = evaluation::Outcome::kCompleted;
  for (const evaluation::AlignmentMode mode : evaluation::all_alignment_modes()) {
    evaluation::AlignmentScore& aligned = score.alignments[mode];
    aligned.mode = mode;
    aligned.position_m = {0.1, 0.1, 0.1, 0.2};
    aligned.rotation_deg = aligned.rotation_euler_norm_deg = aligned.position_m;
    for (const double length_m : evaluation::Options().rpe_lengths_m) {
      aligned.relative.push_back({length_m, 10, 0.1, 0.1, 0.1, 0.1});
    }
  }
  return server::json_from(metrics);
}

/// A manager over a folder of many runs, which live as long as the program.
server::RunManager& manager() {
  static const testing::TemporaryFolder folder;
  static const std::unique_ptr<server::RunManager> runs = [] {
    fs::create_directories(folder.path() / "scenarios");
    const std::string metrics = metrics_document().dump(2);
    for (int i = 0; i < kRuns; ++i) {
      const fs::path run = folder.path() / "runs" / run_name(i);
      fs::create_directories(run);
      testing::write_text(server::created_file(run),
                          json{{"created_utc", server::utc_text(1'000'000'000LL * i)}}.dump(2));
      testing::write_text(server::manifest_file(run), manifest_of(i).dump(2));
      testing::write_text(server::metrics_file(run), metrics);
    }
    server::RunManagerOptions options;
    options.runs_folder = folder.path() / "runs";
    options.scenarios_folder = folder.path() / "scenarios";
    auto made = server::RunManager::create(options);
    if (!made) {
      std::cerr << made.error().message << "\n";
      std::exit(1);
    }
    return std::move(*made);
  }();
  return *runs;
}

/// Reads every run's files, as a server does at its first list.
void first_list(benchmark::State& state) {
  const fs::path folder = manager().folder(run_name(0)).value().parent_path();
  for (auto _ : state) benchmark::DoNotOptimize(server::RunIndex(folder).list({}).size());
}
BENCHMARK(first_list)->Unit(benchmark::kMillisecond);

void list_from_memory(benchmark::State& state) {
  benchmark::DoNotOptimize(manager().runs().size());  // read already
  for (auto _ : state) benchmark::DoNotOptimize(manager().runs().size());
}
BENCHMARK(list_from_memory)->Unit(benchmark::kMicrosecond);

void one_run(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(manager().run(run_name(kRuns / 2)).ok());
}
BENCHMARK(one_run)->Unit(benchmark::kMicrosecond);

void ask(benchmark::State& state, const std::string& target) {
  net::RestRouter router;
  server::ViewService views(manager());
  net::add_run_routes(&router, &manager(), &views);
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
