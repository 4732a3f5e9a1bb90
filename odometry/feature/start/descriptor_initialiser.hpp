// Creates the first map by descriptor matching, for scenes that cannot be tracked by patches over
// one plane.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/camera/camera.hpp"
#include "odometry/feature/map/map.hpp"
#include "odometry/feature/orb.hpp"
#include "odometry/feature/start/descriptor_matcher.hpp"
#include "odometry/feature/start/first_map.hpp"
#include "odometry/geometry/two_view.hpp"
#include "odometry/image/frame_image.hpp"

namespace overfly::odometry::feature {

struct DescriptorInitialiserOptions {
  /// Exceeded by a third of the points: ahead of a camera that moves forward points have no
  /// parallax.
  double min_parallax_rad = 0.05;
  /// A turn moves the reference out of view: after this time `least_parallax_rad` is sufficient.
  double patience_s = 0.25;
  double least_parallax_rad = 0.018;
  bool planar_start = true;
  int coarsest_patch_level = 2;
  double scale_factor = 1.2;  ///< between the corners' levels
  int references = 5;         ///< number of earlier images to compare with
  int full_tries = 62;        ///< then each image is compared with one reference, in turn
  double reference_s = 0.15;  ///< minimum time between references
  int views = 12;             ///< maximum between a reference and the newest image
  int min_matches = 100;
  int min_points = 60;
  int cells = 1000;
  int min_cells = 40;
  std::uint64_t seed = 1;
};

/// Compares each image with several earlier ones by descriptors, so that a missed corner or an
/// image with little content does no harm. Takes the motion from the first reference that is far
/// enough away and refines the pixels by patch alignment.
///
/// Method: descriptor matching with a first frame as in Mur-Artal, Montiel and Tardos 2015, section
/// IV, here with several reference frames; essential matrix by the five-point algorithm.
class DescriptorInitialiser {
 public:
  DescriptorInitialiser(const PinholeCamera& camera, const DescriptorInitialiserOptions& options);

  /// Processes the next frame, see `Initialiser::process`.
  bool process(const FrameImage& frame, OrbExtractor& orb, Map& map);
  /// Adds an image from before the first processed one as a further reference.
  void remember(const FrameImage& frame, OrbExtractor& orb);
  void reset();

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
    std::vector<Eigen::Vector2d> last;  ///< predicted position of each corner
    int misses = 0;                     ///< consecutive images with too few matches
  };

  [[nodiscard]] Pixels match(const Reference& reference, const DescribedCorners& now) const;
  bool compare(Reference& reference,
               const FrameImage& frame,
               const DescribedCorners& now,
               bool try_motion,
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
  int tries_ = 0;                     ///< images compared without success
};

}  // namespace overfly::odometry::feature
