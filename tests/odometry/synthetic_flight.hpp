// A banked flight over textured ground, with images made by casting rays: truth without the other
// rooms.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/motion/pose.hpp"

namespace overfly::odometry::testing {

/// Ground over the east-north plane: a grey texture, repeated beyond its edges, on a height field.
class SyntheticGround {
 public:
  /// @param texture one channel; row 0 is the north
  /// @pre the texture's sides are powers of two
  /// @param relief_m half the height between valley and hill; 0 = flat
  SyntheticGround(Image texture, double texel_m, double relief_m);
  /// Fields, furrows, hedges and speckle at all scales, repeating every size_px texels.
  static SyntheticGround procedural(std::uint64_t seed,
                                    int size_px,
                                    double texel_m,
                                    double relief_m);

  [[nodiscard]] double height_m(double east_m, double north_m) const;
  /// Trilinear samples along every pixel's ray; `noise` is a standard deviation [grey levels].
  /// Lenses are for the same camera over many images: their rays are found once.
  [[nodiscard]] Image render(const CameraModel& camera,
                             const Pose& T_world_camera,
                             double noise,
                             std::uint64_t noise_seed) const;

  /// Grey level at a place, of the texture averaged over so wide an area.
  [[nodiscard]] float sample(double east_m, double north_m, double footprint_m) const;

 private:
  [[nodiscard]] const std::vector<Eigen::Vector3d>& rays_of(const CameraModel& camera) const;

  struct Mip {
    Image image;
    double per_m;  ///< texels in a metre
  };

  std::vector<Mip> mips_;
  mutable CameraModel rays_camera_;
  mutable std::vector<Eigen::Vector3d> rays_;  ///< of rays_camera_, unit length, row by row
  double texel_m_;
  double relief_m_;
};

struct SyntheticFlightOptions {
  double speed_m_s = 25.0;
  double height_m = 300.0;
  double straight_s = 3.0;  ///< level at first
  double roll_rate_max_rad_s = 0.785;
  double bank_max_rad = 0.785;
  double hold_s = 1.0;  ///< at full bank, each way
  double duration_s = 10.0;
  double rate_hz = 31.0;
};

/// T_world_camera of each frame of a level start and S-turns after it: coordinated turns, smooth
/// in roll, nadir mount.
[[nodiscard]] std::vector<Pose> fly_s_turns(const SyntheticFlightOptions& options);

}  // namespace overfly::odometry::testing
