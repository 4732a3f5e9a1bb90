#include "server/experiments/predict/features/patch_camera.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "server/experiments/predict/features/image_features.hpp"

namespace overfly::server::predict {
namespace {

/// Copies a patch to its place in the image of all patches.
template <typename T>
void paste(const ImageBuffer<T>& patch, int x, int y, ImageBuffer<T>& whole) {
  if (whole.empty()) return;
  const auto length = static_cast<std::ptrdiff_t>(patch.width_px) * patch.channels;
  for (int row = 0; row < patch.height_px; ++row) {
    std::copy_n(patch.data.begin() + row * length, length, &whole.at(x, y + row));
  }
}

Image cut(const Image& whole, int x, int y, int width_px, int height_px) {
  Image part(width_px, height_px, 1);
  for (int row = 0; row < height_px; ++row) {
    std::copy_n(&whole.at(x, y + row), width_px, &part.at(0, row));
  }
  return part;
}

}  // namespace

PatchCamera::PatchCamera(const CameraSpec& spec, const PatchLayout& layout)
    : camera_(spec.model), composed_(spec), per_side_(layout.per_side) {
  const PinholeCamera& whole = spec.model.pinhole();
  width_px_ = std::clamp(whole.width_px / per_side_, 1, layout.side_px);
  height_px_ = std::clamp(whole.height_px / per_side_, 1, layout.side_px);
  for (int i = 0; i < per_side_ * per_side_; ++i) {
    const int column = 2 * (i % per_side_) + 1;
    const int row = 2 * (i / per_side_) + 1;
    places_.push_back({(column * whole.width_px / per_side_ - width_px_) / 2,
                       (row * whole.height_px / per_side_ - height_px_) / 2});
  }
  PinholeCamera composed = whole;
  composed.width_px = width_px_ * per_side_;
  composed.height_px = height_px_ * per_side_;
  composed.cx_px = 0.5 * (composed.width_px - 1);
  composed.cy_px = 0.5 * (composed.height_px - 1);
  composed_.model = CameraModel(composed);
  composed_.images.reset();
}

Result<std::unique_ptr<PatchCamera>> PatchCamera::create(const CameraSpec& spec,
                                                         std::size_t index,
                                                         std::uint64_t seed,
                                                         const PatchLayout& layout) {
  std::unique_ptr<PatchCamera> camera(new PatchCamera(spec, layout));
  auto unit = CameraUnit::create(camera->composed_, index, seed);
  if (!unit) return unit.error();
  camera->unit_ = std::move(*unit);
  return camera;
}

int PatchCamera::settling_shots() const {
  const auto& automatic = composed_.sensor.auto_exposure;
  return composed_.sensor.enabled && automatic ? automatic->settle_frames : 1;
}

bool PatchCamera::noisy() const {
  const sensor::SensorModel& sensor = composed_.sensor;
  return sensor.enabled && (sensor.shot_noise || sensor.read_noise_e > 0.0);
}

renderer::CameraRequest PatchCamera::patch_request(const renderer::CameraRequest& whole,
                                                   const Place& place) const {
  PinholeCamera part = camera_.pinhole();
  const int last_row = part.height_px - 1;
  part.width_px = width_px_;
  part.height_px = height_px_;
  part.cx_px -= place.x;
  part.cy_px -= place.y;
  renderer::CameraRequest request = whole;
  request.camera = CameraModel(part, camera_.distortion());
  request.velocity_world_m_s.setZero();  // nothing is read ahead: the next image is elsewhere
  if (whole.readout_ns > 0 && last_row > 0) {
    const double share = static_cast<double>(height_px_ - 1) / last_row;
    const double middle = (place.y + 0.5 * (height_px_ - 1)) / last_row - 0.5;
    const auto readout_ns = static_cast<double>(whole.readout_ns);
    request.t_ns = whole.t_ns + std::llround(readout_ns * middle);
    request.readout_ns = std::llround(readout_ns * share);
  }
  return request;
}

Result<PatchShot> PatchCamera::expose(const std::vector<AircraftState>& states,
                                      std::int64_t t_ns,
                                      std::int64_t frame,
                                      renderer::Renderer& renderer) {
  const Result<renderer::CameraRequest> whole = unit_->request(states, t_ns);
  if (!whole) return whole.error();
  PatchShot shot;
  shot.T_world_camera = whole->T_world_camera;
  shot.exposure_ns = whole->exposure_ns;
  renderer::CameraFrame light;
  const PinholeCamera& size = composed_.model.pinhole();
  const int channels = renderer::channel_count(whole->format);
  if (renderer::is_linear(whole->format)) {
    light.radiance = RadianceImage(size.width_px, size.height_px, channels);
  } else {
    light.image = Image(size.width_px, size.height_px, channels);
  }
  std::vector<double> texels;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Result<renderer::CameraFrame> drawn =
        renderer.render_camera(patch_request(*whole, places_[i]));
    if (!drawn) return drawn.error();
    const int x = static_cast<int>(i) % per_side_ * width_px_;
    const int y = static_cast<int>(i) / per_side_ * height_px_;
    paste(drawn->radiance, x, y, light.radiance);
    paste(drawn->image, x, y, light.image);
    shot.void_share += drawn->void_fraction / static_cast<double>(places_.size());
    if (drawn->texels_per_pixel_median > 0.0) texels.push_back(drawn->texels_per_pixel_median);
  }
  if (!texels.empty()) {
    std::sort(texels.begin(), texels.end());
    shot.texels_per_pixel = texels[texels.size() / 2];
  }
  if (Status status = develop(std::move(light), frame, shot); !status) return status.error();
  return shot;
}

Status PatchCamera::develop(renderer::CameraFrame light, std::int64_t frame, PatchShot& shot) {
  const renderer::CameraFrame again = noisy() ? light : renderer::CameraFrame();
  CameraShot taken;
  if (Status status = unit_->develop(std::move(light), {}, frame, taken); !status) return status;
  const Image whole = grey_of(taken.image);
  if (noisy()) {
    // The same light with the noise of another frame.
    constexpr std::int64_t kOtherFrame = std::int64_t{1} << 40U;
    CameraShot other;
    if (Status status = unit_->develop(again, {}, frame + kOtherFrame, other, taken.setting);
        !status) {
      return status;
    }
    shot.noise_grey = noise_of(whole, grey_of(other.image));
  }
  for (int i = 0; i < per_side_ * per_side_; ++i) {
    shot.patches.push_back(
        cut(whole, i % per_side_ * width_px_, i / per_side_ * height_px_, width_px_, height_px_));
  }
  return {};
}

}  // namespace overfly::server::predict
