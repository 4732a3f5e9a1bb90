// Motion and structure from two views of a plane or of a general scene.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/motion/pose.hpp"

namespace overfly::odometry {

/// Homography by RANSAC with a refit to the inliers; maps pixels of the first view to the second.
///
/// Method: direct linear transform (Hartley and Zisserman 2003, algorithm 4.1) in RANSAC.
struct HomographyFit {
  Eigen::Matrix3d H_second_first = Eigen::Matrix3d::Identity();  ///< pixels
  int inliers = 0;
};
[[nodiscard]] std::optional<HomographyFit> fit_homography(
    const std::vector<Eigen::Vector2d>& first,
    const std::vector<Eigen::Vector2d>& second,
    double threshold_px,
    std::uint64_t seed);

/// Maps a pixel by a homography.
[[nodiscard]] Eigen::Vector2d transfer(const Eigen::Matrix3d& H, const Eigen::Vector2d& pixel);

struct TwoViewOptions {
  double sigma_px = 1.0;           ///< noise assumed in scores and checks
  double min_parallax_rad = 0.02;  ///< see parallax_share
  int min_points = 60;
  /// Minimum share of pairs that must be good points of the motion. Smaller for descriptor matches.
  double min_good_share = 0.7;
  /// The parallax is the value that this share of the good points exceeds. Points ahead of a camera
  /// that moves forward have no parallax at any distance.
  double parallax_share = 0.5;
  bool consider_plane = true;  ///< if false, the essential matrix is always used
  bool five_point = false;     ///< five-point algorithm, which tolerates more outliers
  std::uint64_t seed = 1;
};

struct TwoViewReconstruction {
  Pose T_second_first;                        ///< translation of unit length
  std::vector<Eigen::Vector3d> points_first;  ///< one for each pair; zero where not good
  std::vector<std::uint8_t> good;
  int good_count = 0;
  std::vector<double> parallaxes_rad;  ///< one for each pair; zero where not good
  double parallax_rad = 0.0;           ///< exceeded by `parallax_share` of the good points
  bool planar = false;                 ///< the homography was chosen
};

/// Chooses between a plane's homography and an essential matrix and computes the motion.
///
/// Method: scores S_H, S_E and the ratio R_H = S_H / (S_H + S_E) > 0.45 of Mur-Artal, Montiel and
/// Tardos 2015, section IV, eqs. 2 and 3 (DOI 10.1109/TRO.2015.2463671), with the calibrated
/// matrix instead of F.
/// @return one motion, or the two motions of a plane if two views cannot distinguish them, the one
/// with more good points first; empty if the motion is ambiguous or the parallax is too small
[[nodiscard]] std::vector<TwoViewReconstruction> reconstruct_two_view(
    const PinholeCamera& camera,
    const std::vector<Eigen::Vector2d>& first,
    const std::vector<Eigen::Vector2d>& second,
    const TwoViewOptions& options);

/// The up to four motions (R, t / d) of a calibrated homography, t of unit length.
///
/// Method: Ma, Soatto, Kosecka and Sastry 2004, An Invitation to 3-D Vision, section 5.3.3.
[[nodiscard]] std::vector<Pose> motions_of_homography(const Eigen::Matrix3d& H_calibrated);

/// Essential matrix from pairs on the plane z = 1, by RANSAC; zero if none is found.
///
/// Method: the five-point algorithm (Nister 2004, DOI 10.1109/TPAMI.2004.17), OpenCV's
/// implementation.
[[nodiscard]] Eigen::Matrix3d essential_of_five(const std::vector<Eigen::Vector2d>& first,
                                                const std::vector<Eigen::Vector2d>& second,
                                                double threshold);

/// The four motions of an essential matrix (Hartley and Zisserman 2003, result 9.19).
[[nodiscard]] std::vector<Pose> motions_of_essential(const Eigen::Matrix3d& E);

}  // namespace overfly::odometry
