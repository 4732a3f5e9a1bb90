#include "server/camera/camera_check.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/cancel.hpp"
#include "core/outside/outside_json.hpp"
#include "renderer/camera/truth_images.hpp"
#include "server/camera/frame_maker.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "terrain/synthesize.hpp"

namespace overfly::server {
namespace {

constexpr int kFewestPatches = 20;
constexpr double kMostLost = 0.05;

/// Data of one frame that the comparison needs.
struct Drawn {
  RadianceImage radiance;
  DepthImage depth;
};

/// The range of radiance that is mapped to the 256 grey levels.
struct Range {
  float low = 0.0F;
  float high = 1.0F;
};

/// The range without the darkest and the brightest percent.
Range range_of(const RadianceImage& image) {
  std::vector<float> values = image.data;
  const auto at = [&](double share) {
    const auto place = values.begin() +
                       static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  const float low = at(0.01);
  return {low, std::max(at(0.99), low + 1e-3F)};
}

/// Stretches the grey levels to the ground's contrast. On faint texture, rounding to the camera's 8
/// bits does not move with the image if the motion is nearly whole pixels; registration then
/// measures 0.05 px that are not caused by geometry.
Image stretched(const RadianceImage& radiance, const Range& range) {
  Image image(radiance.width_px, radiance.height_px, 1);
  std::transform(radiance.data.begin(), radiance.data.end(), image.data.begin(), [&](float value) {
    const float level = 255.0F * (value - range.low) / (range.high - range.low);
    return static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0F, 255.0F)));
  });
  return image;
}

Result<Drawn> draw(renderer::Renderer& renderer, const renderer::CameraRequest& request) {
  Result<renderer::CameraFrame> frame = renderer.render_camera(request);
  if (!frame) return frame.error();
  Result<DepthImage> depth = renderer.render_depth(request);
  if (!depth) return depth.error();
  return Drawn{std::move(frame->radiance), std::move(*depth)};
}

Result<renderer::Registration> compare(renderer::Renderer& renderer,
                                       renderer::CameraRequest first,
                                       renderer::CameraRequest second) {
  first.format = second.format = renderer::PixelFormat::kGreyLinear;
  const Result<Drawn> now = draw(renderer, first);
  if (!now) return now.error();
  const Result<Drawn> next = draw(renderer, second);
  if (!next) return next.error();
  const renderer::PixelRays rays(first.camera);
  const renderer::PointImage points = renderer::world_points(rays, first, now->depth);
  const renderer::VectorImage flow = renderer::optical_flow(points, second, next->depth);
  const Range range = range_of(now->radiance);
  const renderer::WarpedImage predicted =
      renderer::warp_along(stretched(next->radiance, range), flow);
  return renderer::register_images(
      predicted.image, stretched(now->radiance, range), predicted.valid);
}

/// Sensor and faults change the image, not the geometry; they would only make the measurement less
/// precise.
Scenario without_sensor(Scenario scenario) {
  scenario.faults.clear();
  for (CameraSpec& camera : scenario.cameras) camera.sensor.auto_exposure.reset();
  return scenario;
}

std::string px(double value) { return std::to_string(value) + " px"; }

/// @pre !row.pairs.empty()
void judge(CameraCheckRow& row, double limit_px) {
  row.fewest_patches = row.pairs.front().residual.patches;
  for (const CameraCheckPair& pair : row.pairs) {
    const renderer::Registration& found = pair.residual;
    row.worst_median_px = std::max(row.worst_median_px, found.median_px);
    row.worst_p95_px = std::max(row.worst_p95_px, found.p95_px);
    row.fewest_patches = std::min(row.fewest_patches, found.patches);
    row.worst_lost_share =
        std::max(row.worst_lost_share, double(found.lost) / std::max(found.patches, 1));
  }
  if (row.fewest_patches < kFewestPatches) {
    row.fault = "only " + std::to_string(row.fewest_patches) +
                " textured patches in a pair: must be at least " + std::to_string(kFewestPatches);
  } else if (row.worst_median_px > limit_px) {
    row.fault = "median residual " + px(row.worst_median_px) + ": must be at most " + px(limit_px);
  } else if (row.worst_lost_share > kMostLost) {
    row.fault = std::to_string(100.0 * row.worst_lost_share) +
                " % of the patches were not found: must be at most 5 %";
  }
}

/// Adds the pair that begins with frame k to every camera's row.
Status check_pair(FrameMaker& maker, std::int64_t k, std::vector<CameraCheckRow>& rows) {
  const auto now = maker.make(k);
  if (!now) return now.error();
  const auto next = maker.make(k + 1);
  if (!next) return next.error();
  if (!*now || !*next) return {};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto residual =
        compare(maker.renderer(), (*now)->shots[i].request, (*next)->shots[i].request);
    if (!residual) {
      return residual.error().in("camera " + rows[i].camera + ", frame " + std::to_string(k));
    }
    rows[i].pairs.push_back({k, *residual});
  }
  return {};
}

constexpr const char* kBuiltinTest = R"({
  "format_version": 1,
  "name": "camera_self_test",
  "world": {"manifest": "world/world.json"},
  "flight": {"course": {"length_m": 900, "leg_length_m": 300}},
  "cameras": [
    {"name": "pinhole", "width_px": 640, "height_px": 480},
    {"name": "radtan_rolling", "width_px": 640, "height_px": 480,
     "distortion": {"model": "radtan", "coefficients": [-0.2, 0.04, 0.001, -0.001]},
     "sensor": {"readout_ms": 20, "exposure_ms": 1}}
  ]
})";

}  // namespace

Status CameraCheckOptions::validate() const {
  if (pairs < 1 || pairs > 1000) {
    return Error{ErrorCode::kInvalidArgument,
                 "pairs = " + std::to_string(pairs) + ": must be in [1, 1000]"};
  }
  if (!(limit_px > 0.0)) {
    return Error{ErrorCode::kInvalidArgument,
                 "limit_px = " + std::to_string(limit_px) + ": must be above 0"};
  }
  return {};
}

Result<std::vector<CameraCheckRow>> check_camera(const Scenario& scenario,
                                                 const CameraCheckOptions& options) {
  if (Status status = options.validate(); !status) return status.error();
  if (scenario.is_live()) {
    return Error{ErrorCode::kInvalidArgument,
                 "flight: is that of a live vehicle: the check needs one that is known in advance"};
  }
  const Scenario quiet = without_sensor(scenario);
  FrameMakerOptions making;
  making.renderer_factory = options.renderer_factory;
  making.cancel = options.cancel;
  making.notice = options.notice;
  const auto maker = FrameMaker::open(quiet, making);
  if (!maker) return maker.error();
  const std::int64_t last_first = (*maker)->frames_total() - 2;
  if (last_first < 0) {
    return Error{ErrorCode::kInvalidArgument,
                 "the flight has fewer than two frames: nothing can be compared"};
  }
  const std::int64_t pairs = std::min<std::int64_t>(options.pairs, last_first / 2 + 1);
  const std::string backend = (*maker)->renderer().info().backend;
  std::vector<CameraCheckRow> rows;
  for (const CameraSpec& camera : quiet.cameras) {
    rows.push_back({});
    rows.back().camera = camera.name;
    rows.back().backend = backend;
  }
  for (std::int64_t i = 0; i < pairs; ++i) {
    if (is_cancelled(options.cancel)) return Error{ErrorCode::kCancelled, "cancelled"};
    // Spread over the flight without its ends, at least two frames apart.
    const std::int64_t k = pairs == 1 ? last_first / 2 : i * last_first / (pairs - 1);
    if (Status status = check_pair(**maker, k, rows); !status) return status.error();
  }
  for (CameraCheckRow& row : rows) judge(row, options.limit_px);
  return rows;
}

Result<Scenario> camera_check_scenario(const std::filesystem::path& folder) {
  terrain::SynthesisOptions land;
  land.size_m = 1200.0;
  land.texel_m = 0.5;
  const Status made = terrain::synthesize_world(folder / "world", land);
  if (!made) return made.error();
  auto scenario = json_from_outside<nlohmann::json>(kBuiltinTest, "the built-in scenario");
  if (!scenario) return scenario.error();
  return resolve_scenario(std::move(*scenario), {}, folder);
}

}  // namespace overfly::server
