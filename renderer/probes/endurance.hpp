// A long flight rendered in lockstep: measures the cost of its frames and whether memory stays
// bounded.
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

/// A flight from west to east along the middle of the imagery, with gentle rolls.
struct EnduranceOptions {
  double length_m = 5e3;
  double speed_m_s = 60.0;
  double height_m = 300.0;  ///< above the ground, smoothed
  double rate_hz = 31.0;
  double warm_up_s = 20.0;  ///< time at the start that is not measured
  int width_px = 1280;
  int height_px = 960;
  bool wait_for_tiles = true;
  /// As in RendererOptions: the store's budget; the renderer's own tiles take as much again.
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
  /// and the read-ahead threads, without the digest of the pixels.
  double cpu_ms_median = 0.0;
  double cpu_ms_p99 = 0.0;
  double cpu_ms_p999 = 0.0;
  double cpu_ms_max = 0.0;
  /// CPU time of the drawing thread in it; the rest is the rasteriser's and the read-ahead
  /// threads'.
  double thread_cpu_ms_median = 0.0;
  double thread_cpu_ms_p999 = 0.0;
  double wall_ms_median = 0.0;  ///< for drawing
  double wall_ms_max = 0.0;
  /// Resident memory of the process [MB]: the median of each tenth of the counted flight, in order.
  std::array<double, 10> resident_mb_by_tenth{};
  double resident_peak_mb = 0.0;     ///< during the counted flight
  std::size_t tiles_peak_bytes = 0;  ///< in the tile store
  std::int64_t late_tiles = 0;
  TileStoreCounts tiles;     ///< of the store
  std::uint64_t digest = 0;  ///< of all pixels
};

/// Called after each frame with the share done; returning false cancels.
using EnduranceProgress = std::function<bool(double share)>;

/// Errors: kInvalidArgument if the imagery is shorter than the flight, or if fewer than ten frames
/// follow the warm-up; kCancelled; as the renderer's.
[[nodiscard]] Result<EnduranceReport> fly_endurance(
    const std::shared_ptr<const terrain::TileSource>& tiles,
    const EnduranceOptions& options,
    const EnduranceProgress& progress = {});

}  // namespace overfly::renderer
