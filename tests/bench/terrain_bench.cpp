// What a built world saves: opening, tiles and heights from files and from its cache, and what
// building costs per megapixel of imagery.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <stdexcept>

#include "terrain/build_world.hpp"
#include "terrain/synthesize.hpp"
#include "tests/support/support.hpp"

namespace {

namespace fs = std::filesystem;
using namespace overfly;
using namespace overfly::terrain;

enum Source { kSynthetic, kAutzenMasked, kGoletaDegrees };

/// A manifest in its own folder, with one cache.
struct Bench {
  overfly::testing::TemporaryFolder folder;
  WorldSpec spec;
  double megapixels = 0.0;
};

void check(const Status& status) {
  if (!status) throw std::runtime_error(status.error().message);
}

WorldSpec real_spec(const char* imagery, const char* elevation) {
  WorldSpec spec;
  const auto picture = overfly::testing::shared_data(imagery);
  const auto heights = overfly::testing::shared_data(elevation);
  if (!picture || !heights) return spec;
  spec.imagery.emplace_back().file = *picture;
  spec.elevation.emplace_back().file = *heights;
  spec.elevation.back().datum = VerticalDatum::kEllipsoid;
  return spec;
}

/// Null where the data are absent.
Bench* bench_of(Source source) {
  static std::array<std::unique_ptr<Bench>, 3> all;
  std::unique_ptr<Bench>& bench = all[source];
  if (bench) return bench.get();
  bench = std::make_unique<Bench>();
  if (source == kSynthetic) {
    SynthesisOptions options;
    options.size_m = 2048.0;
    options.texel_m = 0.5;
    check(synthesize_world(bench->folder.path() / "world", options, {}));
    auto spec = read_world_manifest(bench->folder.path() / "world" / "world.json");
    if (!spec) throw std::runtime_error(spec.error().message);
    bench->spec = std::move(*spec);
  } else {
    bench->spec = source == kAutzenMasked ? real_spec("terrain/autzen/ortho_0.3m_utm10.tif",
                                                      "terrain/autzen/dtm_3m_utm10.tif")
                                          : real_spec("terrain/goleta/ortho_epsg4326.tif",
                                                      "terrain/goleta/elevation_epsg4326.tif");
    if (bench->spec.imagery.empty()) return nullptr;
  }
  bench->spec.cache_folder = bench->folder.path() / "world.cache";
  const auto world = open_world(bench->spec);
  if (!world) throw std::runtime_error(world.error().message);
  const TileGrid& grid = world->tiles->grid();
  bench->megapixels = 1e-6 * grid.width_m * grid.height_m / (grid.texel_m * grid.texel_m);
  return bench.get();
}

WorldSpec spec_for(const Bench& bench, bool built) {
  WorldSpec spec = bench.spec;
  if (built) {
    const auto report = build_world(spec);
    if (!report) throw std::runtime_error(report.error().message);
  } else {
    spec.cache_folder.clear();
  }
  return spec;
}

/// Arguments: source, built.
void BM_Open(benchmark::State& state) {
  const Bench* bench = bench_of(static_cast<Source>(state.range(0)));
  if (bench == nullptr) return state.SkipWithError("shared data are absent");
  const WorldSpec spec = spec_for(*bench, state.range(1) != 0);
  for (auto _ : state) {
    auto world = open_world(spec);
    if (!world) throw std::runtime_error(world.error().message);
    benchmark::DoNotOptimize(world->tiles);
  }
}

/// Every tile of every level once. Arguments: source, built.
void BM_Tiles(benchmark::State& state) {
  const Bench* bench = bench_of(static_cast<Source>(state.range(0)));
  if (bench == nullptr) return state.SkipWithError("shared data are absent");
  const auto world = open_world(spec_for(*bench, state.range(1) != 0));
  const TileGrid& grid = world->tiles->grid();
  std::int64_t tiles = 0;
  for (auto _ : state) {
    for (int level = 0; level < grid.levels; ++level) {
      for (int row = 0; row <= (grid.rows - 1) >> level; ++row) {
        for (int col = 0; col <= (grid.cols - 1) >> level; ++col, ++tiles) {
          auto tile = world->tiles->tile({level, col, row});
          benchmark::DoNotOptimize(tile);
        }
      }
    }
  }
  state.counters["ms_per_tile"] = benchmark::Counter(
      1e-3 * static_cast<double>(tiles), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Argument: source.
void BM_Build(benchmark::State& state) {
  const Bench* bench = bench_of(static_cast<Source>(state.range(0)));
  if (bench == nullptr) return state.SkipWithError("shared data are absent");
  std::uint64_t bytes = 0;
  for (auto _ : state) {
    state.PauseTiming();
    fs::remove_all(bench->spec.cache_folder);
    state.ResumeTiming();
    const auto report = build_world(bench->spec);
    if (!report) throw std::runtime_error(report.error().message);
    bytes = report->bytes;
  }
  state.counters["s_per_megapixel"] =
      benchmark::Counter(bench->megapixels * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["megapixels"] = bench->megapixels;
  state.counters["bytes_per_pixel"] = 1e-6 * static_cast<double>(bytes) / bench->megapixels;
}

BENCHMARK(BM_Open)->ArgsProduct({{0, 1, 2}, {0, 1}})->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Tiles)->ArgsProduct({{0, 1, 2}, {0, 1}})->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(BM_Build)
    ->DenseRange(0, 2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
