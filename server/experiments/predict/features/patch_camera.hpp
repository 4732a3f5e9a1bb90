// Patches of a camera's image, drawn and exposed as the camera would, so that an instant costs a
// small part of a whole image.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "server/camera/camera_unit.hpp"
#include "server/scenario/camera_spec.hpp"

namespace overfly::server::predict {

/// `per_side` x `per_side` squares of up to `side_px`, each in the middle of its part of the image.
struct PatchLayout {
  int per_side = 3;
  int side_px = 96;
};
/// Of an instant of the flight, and of a cell of the map.
inline constexpr PatchLayout kFlightPatches{3, 96};
inline constexpr PatchLayout kMapPatches{2, 64};

struct PatchShot {
  std::vector<Image> patches;     ///< grey; row by row
  double texels_per_pixel = 0.0;  ///< median of the patches with imagery; 0 = none has any
  double void_share = 0.0;
  double noise_grey = 0.0;
  CameraMotion T_world_camera;
  std::int64_t exposure_ns = 0;  ///< 0 = an instant
};

/// One camera with its shutter, lens and sensor. The patches are exposed together as one image:
/// auto-exposure meters them, and vignetting is that of an image of their size. Faults are left
/// out. Used on one thread.
class PatchCamera {
 public:
  /// Errors: as CameraUnit::create.
  [[nodiscard]] static Result<std::unique_ptr<PatchCamera>> create(const CameraSpec& spec,
                                                                   std::size_t index,
                                                                   std::uint64_t seed,
                                                                   const PatchLayout& layout);

  /// Truth that an exposure needs: as of CameraUnit.
  [[nodiscard]] std::int64_t half_window_ns() const { return unit_->half_window_ns(); }
  [[nodiscard]] std::int64_t raster_ns() const { return unit_->raster_ns(); }
  [[nodiscard]] Pose T_world_camera(const Pose& T_world_body, std::int64_t t_ns) const {
    return unit_->T_world_camera(T_world_body, t_ns);
  }
  /// Exposures that auto-exposure needs to settle; 1 without it.
  [[nodiscard]] int settling_shots() const;

  /// @param states  as of CameraUnit::request
  /// @param frame  seeds the noise
  /// Errors: the renderer's.
  [[nodiscard]] Result<PatchShot> expose(const std::vector<AircraftState>& states,
                                         std::int64_t t_ns,
                                         std::int64_t frame,
                                         renderer::Renderer& renderer);

 private:
  struct Place {
    int x = 0;
    int y = 0;
  };
  PatchCamera(const CameraSpec& spec, const PatchLayout& layout);
  [[nodiscard]] renderer::CameraRequest patch_request(const renderer::CameraRequest& whole,
                                                      const Place& place) const;
  /// The shot's patches and noise, from the light of all patches in one image.
  Status develop(renderer::CameraFrame light, std::int64_t frame, PatchShot& shot);
  [[nodiscard]] bool noisy() const;

  CameraModel camera_;   ///< the whole image
  CameraSpec composed_;  ///< of the patches side by side
  int width_px_ = 0;     ///< of a patch
  int height_px_ = 0;
  int per_side_ = 1;
  std::vector<Place> places_;  ///< upper left pixels
  std::unique_ptr<CameraUnit> unit_;
};

}  // namespace overfly::server::predict
