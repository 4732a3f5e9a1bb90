// The first map of scenes whose corners cannot be followed by patches over one plane.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/camera.hpp"
#include "odometry/feature/descriptor_matcher.hpp"
#include "odometry/feature/first_map.hpp"
#include "odometry/feature/frame_image.hpp"
#include "odometry/feature/map.hpp"
#include "odometry/feature/orb.hpp"
#include "odometry/feature/two_view.hpp"

namespace overfly::odometry {

struct DescriptorInitialiserOptions {
  /// Which a third of the points exceed: ahead of a camera that moves forward there is none.
  double min_parallax_rad = 0.05;
  /// A turn takes the reference out of sight: after so long, less will do.
  double patience_s = 0.25;
  double least_parallax_rad = 0.018;
  bool planar_start = true;
  int coarsest_patch_level = 2;
  double scale_factor = 1.2;  ///< of the corners' levels
  int references = 5;         ///< earlier images that a new one is compared with
  double reference_s = 0.15;  ///< between them, at least
  int views = 12;             ///< between a reference and the newest, at most
  int min_matches = 100;
  int min_points = 60;
  int cells = 1000;
  int min_cells = 40;
  std::uint64_t seed = 1;
};

/// Compares each image with several earlier ones by descriptors, so that a corner that is missed
/// once, or an image that shows little, costs nothing; takes the motion from the first that is far
/// enough away, then the pixels from patches.
///
/// Method: matching by descriptors with a first frame, as Mur-Artal, Montiel and Tardos 2015,
/// section IV, here with several; the essential matrix by five points.
class DescriptorInitialiser {
 public:
  DescriptorInitialiser(const PinholeCamera& camera, const DescriptorInitialiserOptions& options);

  /// Takes the next frame, as `Initialiser::process`.
  bool process(const FrameImage& frame, OrbExtractor& orb, Map& map);
  /// Takes an image from before the first that was processed: a reference more.
  void remember(const FrameImage& frame, OrbExtractor& orb);
  void reset() { references_.clear(); }

 private:
  using Pixels = std::vector<std::optional<Eigen::Vector2d>>;  ///< one for each corner
  struct View {
    FrameImage frame;
    Pixels pixels;
  };
  struct Reference {
    FrameImage frame;
    DescribedCorners described;
    std::vector<View> views;
    std::vector<Eigen::Vector2d> last;  ///< where each corner should be by now
    int misses = 0;                     ///< images in a row that showed too little of it
  };

  [[nodiscard]] Pixels match(const Reference& reference, const DescribedCorners& now) const;
  bool compare(Reference& reference,
               const FrameImage& frame,
               const DescribedCorners& now,
               OrbExtractor& orb,
               Map& map) const;
  [[nodiscard]] std::vector<TwoViewReconstruction> motions(const Reference& reference,
                                                           const Pixels& pixels,
                                                           const std::vector<std::size_t>& matched,
                                                           double waited_s) const;
  [[nodiscard]] FirstMapInput input_of(const Reference& reference,
                                       const View& last,
                                       const std::vector<std::size_t>& matched,
                                       const TwoViewReconstruction& motion) const;
  [[nodiscard]] bool spread(const FirstMapInput& input) const;
  void keep(const FrameImage& frame, const DescribedCorners& now);
  void add_reference(const FrameImage& frame, const DescribedCorners& now);

  PinholeCamera camera_;
  DescriptorInitialiserOptions options_;
  std::deque<Reference> references_;  ///< oldest first
};

}  // namespace overfly::odometry
