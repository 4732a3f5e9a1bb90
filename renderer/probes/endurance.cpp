#include "renderer/probes/endurance.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "core/measure/process_memory.hpp"
#include "core/measure/processor_time.hpp"
#include "core/measure/quantile.hpp"
#include "core/time.hpp"

namespace overfly::renderer {

namespace {

/// FNV-1a over words of eight bytes, folded so that their high bits count as well.
std::uint64_t digest_of(const Image& image, std::uint64_t digest) {
  constexpr std::uint64_t kPrime = 0x100000001B3ULL;
  std::size_t i = 0;
  for (; i + 8 <= image.data.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, &image.data[i], 8);
    digest = (digest ^ word) * kPrime;
    digest ^= digest >> 32U;
  }
  for (; i < image.data.size(); ++i) digest = (digest ^ image.data[i]) * kPrime;
  return digest;
}

/// The flight path: the camera's position at a time.
class Track {
 public:
  Track(const terrain::TileSource& tiles, const EnduranceOptions& options)
      : tiles_(tiles), options_(options) {}

  [[nodiscard]] Eigen::Vector3d position(double t_s) const {
    const terrain::TileGrid& grid = tiles_.grid();
    // Starts where the first image lies within the imagery.
    const double x_m = grid.left_x_m + options_.height_m + options_.speed_m_s * t_s;
    // Smoothed elevation, as a pilot would follow it.
    Eigen::Vector3d p =
        tiles_.coarse_world_from_map(x_m, grid.top_y_m - 0.5 * grid.height_m, 400.0);
    p.z() += options_.height_m;
    return p;
  }

  [[nodiscard]] CameraRequest request(double t_s) const {
    const auto camera = PinholeCamera::from_fov(
        options_.width_px, options_.height_px, rad_from_deg(84.872), FovAxis::kHorizontal);
    const RollPitchYaw attitude{0.15 * std::sin(0.5 * t_s), 0.03 * std::sin(0.3 * t_s), 0.5 * kPi};
    const Eigen::Vector3d p = position(t_s);
    CameraRequest request =
        CameraRequest::still(camera.value(),
                             {R_world_body_from(attitude) * R_body_camera_nadir(), p},
                             std::llround(t_s * 1e9),
                             PixelFormat::kGrey8);
    request.velocity_world_m_s = position(t_s + 1.0) - p;
    request.tile_wait_ns = options_.wait_for_tiles ? kForAllTiles : 0;
    return request;
  }

 private:
  const terrain::TileSource& tiles_;
  const EnduranceOptions& options_;
};

/// The costs of the counted frames, in flight order.
struct FrameSeries {
  std::vector<double> cpu_ms, thread_cpu_ms, wall_ms, resident_mb;

  void summarise(EnduranceReport& report) const {
    report.frames_counted = static_cast<int>(cpu_ms.size());
    report.cpu_ms_median = quantile(cpu_ms, 0.5);
    report.cpu_ms_p99 = quantile(cpu_ms, 0.99);
    report.cpu_ms_p999 = quantile(cpu_ms, 0.999);
    report.cpu_ms_max = quantile(cpu_ms, 1.0);
    report.thread_cpu_ms_median = quantile(thread_cpu_ms, 0.5);
    report.thread_cpu_ms_p999 = quantile(thread_cpu_ms, 0.999);
    report.wall_ms_median = quantile(wall_ms, 0.5);
    report.wall_ms_max = quantile(wall_ms, 1.0);
    report.resident_peak_mb = quantile(resident_mb, 1.0);
    const std::size_t tenths = report.resident_mb_by_tenth.size();
    for (std::size_t i = 0; i < tenths; ++i) {
      const auto place = [&](std::size_t tenth) {
        return resident_mb.begin() +
               static_cast<std::ptrdiff_t>(tenth * resident_mb.size() / tenths);
      };
      report.resident_mb_by_tenth[i] = quantile({place(i), place(i + 1)}, 0.5);
    }
  }
};

Status check(const terrain::TileSource& tiles, const EnduranceOptions& options) {
  const double length_m = options.length_m + 2.0 * options.height_m;
  if (tiles.grid().width_m < length_m) {
    return Error{ErrorCode::kInvalidArgument,
                 "the imagery is " + std::to_string(tiles.grid().width_m) +
                     " m wide: the flight needs " + std::to_string(length_m) + " m"};
  }
  const double flight_s = options.length_m / options.speed_m_s;
  if ((flight_s - options.warm_up_s) * options.rate_hz < 11.0) {
    return Error{ErrorCode::kInvalidArgument,
                 "the flight of " + std::to_string(flight_s) +
                     " s must contain at least ten frames after its warm-up of " +
                     std::to_string(options.warm_up_s) + " s"};
  }
  return {};
}

RendererOptions renderer_options_of(const std::shared_ptr<const terrain::TileSource>& tiles,
                                    const EnduranceOptions& options) {
  RendererOptions result;
  result.tile_cache_bytes = options.tile_cache_bytes;
  result.tile_store = options.tile_store;
  if (result.tile_store == nullptr) {
    result.tile_store =
        std::make_shared<TileStore>(tiles, TileStoreOptions{options.tile_cache_bytes, 1});
  }
  result.device = options.device;
  result.camera_backend = options.camera_backend;
  result.threads = options.threads;
  return result;
}

/// Draws the frames and records their costs.
class Flight {
 public:
  Flight(const terrain::TileSource& tiles, const EnduranceOptions& options, TileStore& store)
      : options_(options), track_(tiles, options), store_(store) {
    report_.digest = 0xCBF29CE484222325ULL;
    report_.frames = static_cast<int>(options.length_m / options.speed_m_s * options.rate_hz);
  }

  Status draw(Renderer& renderer, int number) {
    const double t_s = number / options_.rate_hz;
    const CameraRequest request = track_.request(t_s);
    const double drawing_from_s = thread_cpu_s();
    const auto before = std::chrono::steady_clock::now();
    const Result<CameraFrame> drawn = renderer.render_camera(request);
    if (!drawn.ok()) return drawn.error();
    const std::chrono::duration<double, std::milli> wall =
        std::chrono::steady_clock::now() - before;
    const double own_s = thread_cpu_s();
    report_.digest = digest_of(drawn->image, report_.digest);
    report_.late_tiles += drawn->late_tiles;
    report_.tiles_peak_bytes = std::max(report_.tiles_peak_bytes, store_.held_bytes());
    const bool counted = t_s >= options_.warm_up_s;
    if (counted) {
      series_.resident_mb.push_back(resident_memory_mb());
      series_.wall_ms.push_back(wall.count());
      series_.thread_cpu_ms.push_back(1e3 * (own_s - drawing_from_s));
    }
    // Measured from frame to frame, to include the work of other threads between frames, but
    // without this thread's own measuring work.
    const double now_s = process_cpu_s();
    if (counted) {
      series_.cpu_ms.push_back(1e3 * (now_s - cpu_mark_s_ - (thread_cpu_s() - own_s)));
    }
    cpu_mark_s_ = now_s;
    return {};
  }

  EnduranceReport finish(const Renderer& renderer) {
    report_.renderer = renderer.info();
    report_.tiles = store_.counts();
    series_.summarise(report_);
    return report_;
  }

  [[nodiscard]] int frames() const { return report_.frames; }

 private:
  const EnduranceOptions& options_;
  Track track_;
  TileStore& store_;
  EnduranceReport report_;
  FrameSeries series_;
  double cpu_mark_s_ = process_cpu_s();
};

}  // namespace

Result<EnduranceReport> fly_endurance(const std::shared_ptr<const terrain::TileSource>& tiles,
                                      const EnduranceOptions& options,
                                      const EnduranceProgress& progress) {
  if (Status status = check(*tiles, options); !status) return status.error();
  const RendererOptions renderer_options = renderer_options_of(tiles, options);
  const auto renderer = create_renderer(tiles, renderer_options);
  if (!renderer.ok()) return renderer.error();
  Flight flight(*tiles, options, *renderer_options.tile_store);
  for (int frame = 0; frame < flight.frames(); ++frame) {
    if (Status status = flight.draw(**renderer, frame); !status) return status.error();
    if (progress && !progress((frame + 1.0) / flight.frames())) {
      return Error{ErrorCode::kCancelled, "cancelled"};
    }
  }
  return flight.finish(**renderer);
}

}  // namespace overfly::renderer
