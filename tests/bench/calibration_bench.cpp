// Images of virtual boards, 1280x960: five views each, with and without markers and a lens.
#include <benchmark/benchmark.h>

#include "calibration/virtual/virtual_board.hpp"
#include "calibration/virtual/virtual_views.hpp"

namespace overfly::calibration {
namespace {

constexpr int kViews = 5;

/// @param state  range(0): with markers; range(1): radial-tangential lens
void draw_views(benchmark::State& state) {
  const PinholeCamera pinhole{1280, 960, 700.0, 700.0, 639.5, 479.5};
  const Distortion lens{DistortionModel::kRadtan, {-0.2, 0.05, 0.001, -0.0005, 0.0}};
  const CameraModel camera =
      state.range(1) != 0 ? CameraModel(pinhole, lens) : CameraModel(pinhole);
  Board board{9, 6, 0.03};
  if (state.range(0) != 0) board.markers = BoardMarkers{4, 0.022};
  const auto poses = virtual_views(camera, board, kViews, 3);
  for (auto _ : state) {
    const BoardPainter painter(camera);
    for (const Pose& pose : poses) benchmark::DoNotOptimize(painter.draw(board, pose));
  }
  state.SetItemsProcessed(state.iterations() * kViews);
}
BENCHMARK(draw_views)
    ->ArgNames({"markers", "lens"})
    ->ArgsProduct({{0, 1}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace overfly::calibration

BENCHMARK_MAIN();
