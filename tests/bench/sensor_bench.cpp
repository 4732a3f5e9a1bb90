// What the sensor's image chain costs for one frame of 1280 x 960, in units Q: the CPU time of one
// textured quad drawn by OpenGL in the same run. Run: sensor_bench [--benchmark_filter=...]
// Every figure is the median of the ratios of neighbouring calls, which a busy machine disturbs
// less than the ratio of medians.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "core/measure/processor_time.hpp"
#include "renderer/probes/bench_probe.hpp"
#include "sensor/image_faults.hpp"
#include "sensor/mount_vibration.hpp"
#include "sensor/sensor.hpp"
#include "tests/bench/median.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::sensor {
namespace {

using renderer::PixelFormat;

constexpr int kRounds = 80;

PinholeCamera pinhole() {
  return PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal).value();
}

/// The light of painted hills 300 m below.
const RadianceImage& ground_light(PixelFormat format) {
  static const auto drawn = [](PixelFormat of) {
    const auto tiles = overfly::testing::natural_ground();
    const Pose pose{R_world_body_from({0.1, 0.05, 0.7}) * R_body_camera_nadir(),
                    {20.0, 30.0, tiles->ground_up_m(20.0, 30.0) + 300.0}};
    return renderer::create_raycast_renderer(tiles)
        ->render_camera(pinhole(), pose, 0, of)
        ->radiance;
  };
  static const RadianceImage grey = drawn(PixelFormat::kGreyLinear);
  static const RadianceImage rgb = drawn(PixelFormat::kRgbLinear);
  return format == PixelFormat::kRgbLinear ? rgb : grey;
}

double cpu_s(const std::function<void()>& call) {
  const double before_s = process_cpu_s();
  call();
  return process_cpu_s() - before_s;
}

/// Measures calls in turn with the quad.
void call_per_quad(benchmark::State& state, const std::function<void(int round)>& call) {
  const auto quad = renderer::QuadProbe::create();
  if (!quad.ok()) return state.SkipWithError(quad.error().message.c_str());
  for (int i = 0; i < 5; ++i) {
    (void)(*quad)->draw();
    call(i);
  }
  for (auto _ : state) {
    std::vector<double> ratios, call_ms;
    for (int i = 0; i < kRounds; ++i) {
      const double quad_s = cpu_s([&] { (void)(*quad)->draw(); });
      const double call_s = cpu_s([&] { call(i); });
      ratios.push_back(call_s / quad_s);
      call_ms.push_back(1e3 * call_s);
    }
    state.counters["per_quad"] = testing::median(ratios);
    state.counters["cpu_ms"] = testing::median(call_ms);
  }
}

/// Every stage but defocus and blur, as a real 8-bit camera has them.
SensorModel whole_chain() {
  SensorModel model;
  model.enabled = true;
  model.vignette = Vignette{{-0.25, 0.05, -0.02}};
  model.shot_noise = true;
  model.read_noise_e = 8.0;
  model.full_well_e = 10000.0;
  model.black_level_dn = 2.0;
  return model;
}

SensorModel with(const std::function<void(SensorModel&)>& change) {
  SensorModel model = whole_chain();
  change(model);
  return model;
}

void chain(benchmark::State& state,
           const SensorModel& model,
           PixelFormat format,
           VectorUnits units,
           float brightness) {
  if (!supported(units)) return state.SkipWithError("this machine has not these vector units");
  RadianceImage light = ground_light(format);
  for (float& value : light.data) value *= brightness;
  const auto sensor = Sensor::create(model, pinhole(), 1, units);
  if (!sensor.ok()) return state.SkipWithError(sensor.error().message.c_str());
  call_per_quad(state, [&](int round) {
    benchmark::DoNotOptimize((*sensor)->expose(light, round).mean_level);
  });
}

void fault(benchmark::State& state, const ImageFault& fault) {
  RadianceImage light = ground_light(PixelFormat::kGreyLinear);
  call_per_quad(state, [&](int) { apply_fault(fault, light); });
}

/// The poses that a blurred rolling-shutter frame asks for.
void vibration(benchmark::State& state) {
  VibrationModel model;
  model.enabled = true;
  model.engine_rotation_rms_rad = {1e-4, 5e-5};
  model.noise_rotation_rms_rad = {1e-4, 1e-4, 1e-4};
  const auto shaken = MountVibration::create(model, 1).value();
  call_per_quad(state, [&](int round) {
    for (int i = 0; i < 32; ++i) {
      benchmark::DoNotOptimize(shaken.T_mount_camera(round * 32'000'000LL + i * 1'000'000LL));
    }
  });
}

constexpr auto kGrey = PixelFormat::kGreyLinear;
constexpr auto kRgb = PixelFormat::kRgbLinear;
constexpr auto kBest = VectorUnits::kBest;

#define OVERFLY_CHAIN(name, ...) \
  BENCHMARK_CAPTURE(chain, name, __VA_ARGS__)->Iterations(1)->Unit(benchmark::kMillisecond)

OVERFLY_CHAIN(whole_8_bit, whole_chain(), kGrey, kBest, 1.0F);
OVERFLY_CHAIN(whole_8_bit_avx2, whole_chain(), kGrey, VectorUnits::kAvx2, 1.0F);
OVERFLY_CHAIN(whole_8_bit_no_vector_units, whole_chain(), kGrey, VectorUnits::kNone, 1.0F);
OVERFLY_CHAIN(whole_12_bit, with([](SensorModel& m) { m.bits = 12; }), kGrey, kBest, 1.0F);
OVERFLY_CHAIN(linear_8_bit,
              with([](SensorModel& m) { m.response = ResponseCurve::linear(); }),
              kGrey,
              kBest,
              1.0F);
OVERFLY_CHAIN(fixed_patterns,
              with([](SensorModel& m) { m.prnu = 0.01, m.dsnu_e = 2.0; }),
              kGrey,
              kBest,
              1.0F);
OVERFLY_CHAIN(
    auto_exposure, with([](SensorModel& m) { m.auto_exposure.emplace(); }), kGrey, kBest, 1.0F);
OVERFLY_CHAIN(few_electrons_at_dusk, whole_chain(), kGrey, kBest, 0.005F);
OVERFLY_CHAIN(no_stage, with([](SensorModel& m) { m = SensorModel{}; }), kGrey, kBest, 1.0F);
OVERFLY_CHAIN(whole_8_bit_rgb, whole_chain(), kRgb, kBest, 1.0F);
OVERFLY_CHAIN(with_defocus_of_1_px,
              with([](SensorModel& m) { m.defocus_sigma_px = 1.0; }),
              kGrey,
              kBest,
              1.0F);
#define OVERFLY_FAULT(name, ...) \
  BENCHMARK_CAPTURE(fault, name, __VA_ARGS__)->Iterations(1)->Unit(benchmark::kMillisecond)
OVERFLY_FAULT(saturation, ImageFault{ImageFaultKind::kSaturation, 1e-6, 200.0, 0, 1});
OVERFLY_FAULT(dirt, ImageFault{ImageFaultKind::kDirt, 0.5, 40.0, 0, 1});
OVERFLY_FAULT(water_drop, ImageFault{ImageFaultKind::kWaterDrop, 0.5, 100.0, 0, 1});
BENCHMARK(vibration)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace overfly::sensor

BENCHMARK_MAIN();
