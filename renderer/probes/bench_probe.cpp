#include "renderer/probes/bench_probe.hpp"

#include <chrono>
#include <functional>
#include <optional>

#include "core/measure/processor_time.hpp"
#include "core/measure/quantile.hpp"

namespace overfly::renderer {

namespace {

double median(const std::vector<double>& values) { return quantile(values, 0.5); }

/// The costs of repeated calls, in the order of the calls.
struct Series {
  std::vector<double> cpu_ms, wall_ms;

  Status time(const std::function<Status()>& call) {
    const double cpu_before_s = process_cpu_s();
    const auto before = std::chrono::steady_clock::now();
    Status status = call();
    const std::chrono::duration<double, std::milli> wall =
        std::chrono::steady_clock::now() - before;
    cpu_ms.push_back(1e3 * (process_cpu_s() - cpu_before_s));
    wall_ms.push_back(wall.count());
    return status;
  }

  [[nodiscard]] CallCost cost() const { return {median(cpu_ms), median(wall_ms)}; }
};

template <typename T>
Status status_of(const Result<T>& result) {
  return result.ok() ? Status() : Status(result.error());
}

PinholeCamera standard_camera() {
  return PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal).value();
}

/// The nadir camera at the same place and heading, with the wings rolled by `roll_rad`.
Pose banked(const Pose& T_world_camera, double roll_rad) {
  const Eigen::Quaterniond R_world_body =
      T_world_camera.rotation * R_body_camera_nadir().conjugate();
  const double yaw_rad = attitude_from(R_world_body).yaw_rad;
  return {R_world_body_from({roll_rad, 0.0, yaw_rad}) * R_body_camera_nadir(),
          T_world_camera.translation};
}

/// Median of the ratios of neighbouring calls' CPU times.
double per_quad(const Series& calls, const Series& quads) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < quads.cpu_ms.size(); ++i) {
    ratios.push_back(calls.cpu_ms[i] / quads.cpu_ms[i]);
  }
  return median(ratios);
}

class Measurement {
 public:
  Measurement(Renderer& renderer, Renderer& raycaster, QuadProbe& quad)
      : renderer_(renderer), raycaster_(raycaster), quad_(quad) {}

  Status warm_up(const Pose& pose) {
    Measurement unused(renderer_, raycaster_, quad_);
    return unused.round(pose);
  }

  Status round(const Pose& pose) {
    if (Status s = quads_.time([&] { return quad_.draw(); }); !s) return s;
    if (Status s = grey_.time([&] { return camera(pose, PixelFormat::kGrey8); }); !s) return s;
    if (Status s = rgb_.time([&] { return camera(pose, PixelFormat::kRgb8); }); !s) return s;
    if (Status s = depth_.time([&] { return status_of(renderer_.render_depth(camera_, pose)); });
        !s) {
      return s;
    }
    if (Status s = cast(banked(pose, 0.0), level_casts_); !s) return s;
    if (Status s = cast(banked(pose, rad_from_deg(45.0)), banked_casts_); !s) return s;
    return scene_.time([&] {
      SceneView view;
      view.T_world_camera = pose;
      SceneContent content;
      content.aircraft.push_back({{pose.rotation * R_body_camera_nadir().conjugate(),
                                   pose.translation + pose.rotation * Eigen::Vector3d(0, 0, 30)},
                                  {0.9F, 0.1F, 0.1F},
                                  8.0,
                                  false});
      return status_of(renderer_.render_scene(view, content));
    });
  }

  [[nodiscard]] RenderCosts costs() const {
    return {quads_.cost(),
            grey_.cost(),
            rgb_.cost(),
            depth_.cost(),
            scene_.cost(),
            per_quad(grey_, quads_),
            per_quad(level_casts_, quads_),
            per_quad(banked_casts_, quads_)};
  }

 private:
  Status camera(const Pose& pose, PixelFormat format) {
    return status_of(renderer_.render_camera(camera_, pose, 0, format));
  }

  /// Measured after its ground was prepared, as in flight, where each view is near the previous
  /// one.
  Status cast(const Pose& pose, Series& series) {
    const auto draw = [&] {
      return status_of(raycaster_.render_camera(camera_, pose, 0, PixelFormat::kGrey8));
    };
    if (Status status = draw(); !status) return status;
    return series.time(draw);
  }

  Renderer& renderer_;
  Renderer& raycaster_;
  QuadProbe& quad_;
  PinholeCamera camera_ = standard_camera();
  Series quads_, grey_, rgb_, depth_, scene_, level_casts_, banked_casts_;
};

}  // namespace

Result<RenderCosts> measure_render_costs(const std::shared_ptr<const terrain::TileSource>& tiles,
                                         const std::vector<Pose>& T_world_camera,
                                         int repetitions,
                                         const std::string& device) {
  if (T_world_camera.empty() || repetitions < 1) {
    return Error{ErrorCode::kInvalidArgument, "render costs need a pose and a repetition"};
  }
  const Result<std::unique_ptr<QuadProbe>> quad = QuadProbe::create(device);
  if (!quad.ok()) return quad.error();
  RendererOptions options;
  options.device = device;
  const Result<std::unique_ptr<Renderer>> renderer = create_egl_renderer(tiles, options);
  if (!renderer.ok()) return renderer.error();
  options.threads = 1;
  const std::unique_ptr<Renderer> raycaster = create_raycast_renderer(tiles, options);
  Measurement measurement(**renderer, *raycaster, **quad);
  for (const Pose& pose : T_world_camera) {
    if (Status status = measurement.warm_up(pose); !status) return status.error();
  }
  for (int i = 0; i < repetitions; ++i) {
    const Status status = measurement.round(T_world_camera[i % T_world_camera.size()]);
    if (!status) return status.error();
  }
  return measurement.costs();
}

}  // namespace overfly::renderer
