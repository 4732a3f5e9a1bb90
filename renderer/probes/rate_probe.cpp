#include <chrono>
#include <cstring>
#include <functional>
#include <string>
#include <utility>

#include "core/measure/quantile.hpp"
#include "renderer/camera_pipeline.hpp"
#include "renderer/probes/bench_probe.hpp"
#include "renderer/tiles/tile_store.hpp"

namespace overfly::renderer {

namespace {

constexpr int kBatch = 16;  // calls timed together

/// Wall time of a call [s], added to `times`.
Status time(std::vector<double>& times, const std::function<Status()>& call) {
  const auto before = std::chrono::steady_clock::now();
  if (Status status = call(); !status) return status;
  times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count());
  return {};
}

Status repeat(int count, const std::function<Status()>& call) {
  for (int i = 0; i < count; ++i) {
    if (Status status = call(); !status) return status;
  }
  return {};
}

double per_s(const std::vector<double>& times) { return kBatch / quantile(times, 0.5); }

/// Draws frames along the poses with as many in flight as the pipeline allows.
class PipedCamera {
 public:
  PipedCamera(CameraPipeline pipeline, int in_flight)
      : pipeline_(std::move(pipeline)), in_flight_(in_flight) {}

  Status frames(const std::vector<Pose>& poses, int count) {
    const PinholeCamera camera =
        PinholeCamera::from_fov(
            kProbeWidthPx, kProbeHeightPx, rad_from_deg(84.872), FovAxis::kHorizontal)
            .value();
    for (int i = 0; i < count + in_flight_; ++i) {
      if (i >= in_flight_) {
        if (const auto frame = pipeline_.finish(); !frame.ok()) return frame.error();
      }
      if (i >= count) continue;
      const Pose& pose = poses[next_++ % poses.size()];
      Status begun = pipeline_.begin(CameraRequest::still(camera, pose, 0, PixelFormat::kGrey8));
      if (!begun) return begun;
    }
    return {};
  }

  [[nodiscard]] int in_flight() const { return in_flight_; }
  std::vector<double> times;

 private:
  CameraPipeline pipeline_;
  int in_flight_;
  std::size_t next_ = 0;
};

/// The ceilings: copies in memory, readback and fill.
struct Ceilings {
  std::vector<double> memcpy_s, readback_s, fill_s, copy_s;
  Image from{kProbeWidthPx, kProbeHeightPx, 1, 7}, to{kProbeWidthPx, kProbeHeightPx, 1, 8};

  Status round(QuadProbe& quad) {
    if (Status s = time(fill_s,
                        [&] {
                          Status drawn = repeat(kBatch, [&] { return quad.draw_only(); });
                          return drawn ? quad.wait() : drawn;
                        });
        !s) {
      return s;
    }
    if (Status s = time(readback_s, [&] { return quad.read(); }); !s) return s;
    if (Status s = repeat(3, [&] { return quad.read_piped(); }); !s) return s;
    if (Status s = time(copy_s, [&] { return repeat(kBatch, [&] { return quad.read_piped(); }); });
        !s) {
      return s;
    }
    return time(memcpy_s, [&] {
      std::memcpy(to.data.data(), from.data.data(), to.data.size());
      from.data[0] = to.data[1];  // prevents the copy from being optimised away
      return Status();
    });
  }
};

}  // namespace

Result<RateCosts> measure_rate_costs(const std::shared_ptr<const terrain::TileSource>& tiles,
                                     const std::vector<Pose>& T_world_camera,
                                     int rounds,
                                     const std::string& device) {
  if (T_world_camera.empty() || rounds < 1) {
    return Error{ErrorCode::kInvalidArgument, "rates need a pose and a round"};
  }
  const Result<std::unique_ptr<QuadProbe>> quad = QuadProbe::create(device);
  if (!quad.ok()) return quad.error();
  RendererOptions options;
  options.device = device;
  options.tile_store = std::make_shared<TileStore>(tiles, TileStoreOptions{});
  std::vector<PipedCamera> cameras;
  for (const int in_flight : {1, 2, 4}) {
    Result<CameraPipeline> pipeline = CameraPipeline::create(tiles, options, in_flight);
    if (!pipeline.ok()) return pipeline.error();
    cameras.emplace_back(std::move(*pipeline), in_flight);
    // Visits every pose once, so that tiles and patches are loaded.
    const Status warm =
        cameras.back().frames(T_world_camera, static_cast<int>(T_world_camera.size()));
    if (!warm) return warm.error();
  }
  Ceilings ceilings;
  if (Status status = (*quad)->draw(); !status) return status.error();
  for (int i = 0; i < rounds; ++i) {
    if (Status status = ceilings.round(**quad); !status) return status.error();
    for (PipedCamera& camera : cameras) {
      const Status drawn =
          time(camera.times, [&] { return camera.frames(T_world_camera, kBatch); });
      if (!drawn) return drawn.error();
    }
  }
  RateCosts costs;
  costs.renderer = (*quad)->info();
  costs.memcpy_ms = 1e3 * quantile(ceilings.memcpy_s, 0.5);
  costs.readback_ms = 1e3 * quantile(ceilings.readback_s, 0.5);
  costs.readback_per_memcpy = costs.readback_ms / costs.memcpy_ms;
  costs.fill_per_s = per_s(ceilings.fill_s);
  costs.copy_per_s = per_s(ceilings.copy_s);
  for (const PipedCamera& camera : cameras) {
    costs.camera.push_back({camera.in_flight(), per_s(camera.times)});
  }
  return costs;
}

}  // namespace overfly::renderer
