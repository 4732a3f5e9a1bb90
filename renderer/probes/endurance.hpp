// A long flight drawn in lockstep: what its frames cost, and whether memory stays bounded.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>

#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "renderer/tiles/tile_store.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::renderer {

/// West to east along the middle of the imagery, rolling gently.
struct EnduranceOptions {
  double length_m = 5e3;
  double speed_m_s = 60.0;
  double height_m = 300.0;  ///< above the ground, smoothed
  double rate_hz = 31.0;
  double warm_up_s = 20.0;  ///< of flight, not counted
  int width_px = 1280;
  int height_px = 960;
  bool wait_for_tiles = true;
  /// As RendererOptions: the store's budget, and as many again in the form that is drawn from.
  std::size_t tile_cache_bytes = std::size_t{256} << 20U;
  std::string device;
  CameraBackend camera_backend = CameraBackend::kEgl;
  int threads = 0;
  /// Null = a new one within tile_cache_bytes.
  std::shared_ptr<TileStore> tile_store;
};

struct EnduranceReport {
  RendererInfo renderer;
  int frames = 0;
  int frames_counted = 0;  ///< after the warm-up
  /// CPU time of the whole process per counted frame: drawing, the software rasteriser's threads
  /// and the threads that fetch ahead, without the pixels' digest.
  double cpu_ms_median = 0.0;
  double cpu_ms_p99 = 0.0;
  double cpu_ms_p999 = 0.0;
  double cpu_ms_max = 0.0;
  /// Of these, the thread that draws: what is left is the rasteriser's and the readers' ahead.
  double thread_cpu_ms_median = 0.0;
  double thread_cpu_ms_p999 = 0.0;
  double wall_ms_median = 0.0;  ///< of drawing
  double wall_ms_max = 0.0;
  /// Resident memory of the process [MB]: the medians of the counted flight's tenths, in order.
  std::array<double, 10> resident_mb_by_tenth{};
  double resident_peak_mb = 0.0;     ///< of the counted flight
  std::size_t tiles_peak_bytes = 0;  ///< kept by the tile store
  std::int64_t late_tiles = 0;
  TileStoreCounts tiles;     ///< of the store
  std::uint64_t digest = 0;  ///< of all pixels
};

/// Called after each frame with the share that is done; false cancels.
using EnduranceProgress = std::function<bool(double share)>;

/// Errors: kInvalidArgument when the imagery is shorter than the flight, or the flight than ten
/// frames after its warm-up; kCancelled; as the renderer's.
[[nodiscard]] Result<EnduranceReport> fly_endurance(
    const std::shared_ptr<const terrain::TileSource>& tiles,
    const EnduranceOptions& options,
    const EnduranceProgress& progress = {});

}  // namespace overfly::renderer
