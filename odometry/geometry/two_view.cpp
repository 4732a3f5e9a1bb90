#include "odometry/geometry/two_view.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "core/algebra/decompositions.hpp"
#include "odometry/geometry/triangulation.hpp"

namespace overfly::odometry {
namespace {

using Pixels = std::vector<Eigen::Vector2d>;

constexpr int kRansacRounds = 200;
// Limits of the chi-square distribution at 5 %: two degrees for a transfer, one for a line.
constexpr double kChi2Point = 5.99;
constexpr double kChi2Line = 3.84;
constexpr double kPlanarRatio = 0.45;
/// A plane's homography allows two motions. The plane of the wrong one is seen edge-on from the
/// first view, and points beyond its horizon lie behind the camera. If these are fewer than a
/// twentieth (camera tilted by about 30 deg at 69 deg field of view), two views cannot distinguish
/// the motions.
constexpr double kMostAlike = 0.95;

Eigen::Matrix3d from_null_vector(const Matrix9d& normal_matrix) {
  const Vector9d h = symmetric_eigen(normal_matrix).vectors.col(0);
  Eigen::Matrix3d m;
  m << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), h(8);
  return m;
}

/// Adds the two rows of one pair to A^T A of the homography's linear system.
void add_homography_rows(const Eigen::Vector2d& a,
                         const Eigen::Vector2d& b,
                         Matrix9d& normal_matrix) {
  Vector9d r1;
  Vector9d r2;
  r1 << 0, 0, 0, -a.x(), -a.y(), -1, b.y() * a.x(), b.y() * a.y(), b.y();
  r2 << a.x(), a.y(), 1, 0, 0, 0, -b.x() * a.x(), -b.x() * a.y(), -b.x();
  normal_matrix += r1 * r1.transpose() + r2 * r2.transpose();
}

void add_epipolar_row(const Eigen::Vector2d& a, const Eigen::Vector2d& b, Matrix9d& normal_matrix) {
  Vector9d r;
  r << b.x() * a.x(), b.x() * a.y(), b.x(), b.y() * a.x(), b.y() * a.y(), b.y(), a.x(), a.y(), 1;
  normal_matrix += r * r.transpose();
}

Eigen::Matrix3d essential_of(const Matrix9d& normal_matrix) {
  const Svd3 parts = svd(from_null_vector(normal_matrix));
  return parts.U * Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal() * parts.V.transpose();
}

/// Draws `count` different indices below `size`.
template <std::size_t N>
std::array<std::size_t, N> draw(std::mt19937_64& generator, std::size_t size) {
  std::array<std::size_t, N> indices{};
  for (std::size_t i = 0; i < N;) {
    indices[i] = generator() % size;
    const auto end = indices.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(indices.begin(), end, indices[i]) == end) ++i;
  }
  return indices;
}

/// Score of a homography between normalised views: from symmetric transfer errors, each point adds
/// the difference between the limit and its squared error.
double score_homography(const Eigen::Matrix3d& H, const Pixels& a, const Pixels& b, double sigma) {
  const Eigen::Matrix3d back = H.inverse();
  const double scale = 1.0 / (sigma * sigma);
  double score = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double forth = (transfer(H, a[i]) - b[i]).squaredNorm() * scale;
    const double return_error = (transfer(back, b[i]) - a[i]).squaredNorm() * scale;
    if (forth < kChi2Point) score += kChi2Point - forth;
    if (return_error < kChi2Point) score += kChi2Point - return_error;
  }
  return score;
}

double line_distance2(const Eigen::Vector3d& line, const Eigen::Vector2d& p) {
  const double value = line.dot(p.homogeneous());
  return value * value / std::max(line.head<2>().squaredNorm(), 1e-18);
}

/// As above with distances to epipolar lines. The same limit is credited, so that scores are
/// comparable.
double score_essential(const Eigen::Matrix3d& E, const Pixels& a, const Pixels& b, double sigma) {
  const double scale = 1.0 / (sigma * sigma);
  double score = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double forth = line_distance2(E * a[i].homogeneous(), b[i]) * scale;
    const double back = line_distance2(E.transpose() * b[i].homogeneous(), a[i]) * scale;
    if (forth < kChi2Line) score += kChi2Point - forth;
    if (back < kChi2Line) score += kChi2Point - back;
  }
  return score;
}

Pixels normalised(const PinholeCamera& camera, const Pixels& pixels) {
  Pixels result;
  result.reserve(pixels.size());
  for (const Eigen::Vector2d& pixel : pixels) result.emplace_back(camera.ray(pixel).head<2>());
  return result;
}

struct Model {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  double score = -1.0;
};

Model ransac_homography(const Pixels& a, const Pixels& b, double sigma, std::mt19937_64& rng) {
  Model best;
  for (int round = 0; round < kRansacRounds; ++round) {
    Matrix9d normal_matrix = Matrix9d::Zero();
    for (const std::size_t i : draw<4>(rng, a.size()))
      add_homography_rows(a[i], b[i], normal_matrix);
    const Eigen::Matrix3d H = from_null_vector(normal_matrix);
    if (std::abs(H.determinant()) < 1e-9) continue;
    const double score = score_homography(H, a, b, sigma);
    if (score > best.score) best = {H, score};
  }
  return best;
}

/// Refits to the inlier pairs and keeps the better model.
Model refined_homography(Model model, const Pixels& a, const Pixels& b, double sigma) {
  for (int round = 0; round < 2 && model.score > 0.0; ++round) {
    Matrix9d normal_matrix = Matrix9d::Zero();
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double error2 = (transfer(model.matrix, a[i]) - b[i]).squaredNorm();
      if (error2 < kChi2Point * sigma * sigma) add_homography_rows(a[i], b[i], normal_matrix);
    }
    const Eigen::Matrix3d H = from_null_vector(normal_matrix);
    const double score = score_homography(H, a, b, sigma);
    if (score > model.score) model = {H, score};
  }
  return model;
}

Model ransac_essential(const Pixels& a, const Pixels& b, double sigma, std::mt19937_64& rng) {
  Model best;
  for (int round = 0; round < kRansacRounds; ++round) {
    Matrix9d normal_matrix = Matrix9d::Zero();
    for (const std::size_t i : draw<8>(rng, a.size())) add_epipolar_row(a[i], b[i], normal_matrix);
    const Eigen::Matrix3d E = essential_of(normal_matrix);
    const double score = score_essential(E, a, b, sigma);
    if (score > best.score) best = {E, score};
  }
  return best;
}

Model five_point_essential(const Pixels& a, const Pixels& b, double sigma) {
  const Eigen::Matrix3d E = essential_of_five(a, b, std::sqrt(kChi2Line) * sigma);
  if (E.isZero()) return {};
  return {E, score_essential(E, a, b, sigma)};
}

/// Triangulates the points that are in front of both cameras and agree with both views.
TwoViewReconstruction triangulate_all(const Pose& T_second_first,
                                      const Pixels& a,
                                      const Pixels& b,
                                      double max_error,
                                      double parallax_share) {
  TwoViewReconstruction result;
  result.T_second_first = T_second_first;
  result.points_first.assign(a.size(), Eigen::Vector3d::Zero());
  result.good.assign(a.size(), 0);
  result.parallaxes_rad.assign(a.size(), 0.0);
  std::vector<double> parallaxes;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto point = triangulate(a[i].homogeneous(), b[i].homogeneous(), T_second_first);
    if (!point) continue;
    const Eigen::Vector3d p_second = T_second_first * point->p_first;
    if ((p_second.hnormalized() - b[i]).norm() > max_error) continue;
    result.points_first[i] = point->p_first;
    result.good[i] = 1;
    ++result.good_count;
    result.parallaxes_rad[i] = point->parallax_rad;
    parallaxes.push_back(point->parallax_rad);
  }
  if (!parallaxes.empty()) {
    const auto rank = static_cast<std::ptrdiff_t>((1.0 - parallax_share) *
                                                  static_cast<double>(parallaxes.size()));
    const auto ranked = parallaxes.begin() + rank;
    std::nth_element(parallaxes.begin(), ranked, parallaxes.end());
    result.parallax_rad = *ranked;
  }
  return result;
}

}  // namespace

Eigen::Vector2d transfer(const Eigen::Matrix3d& H, const Eigen::Vector2d& pixel) {
  return (H * pixel.homogeneous()).hnormalized();
}

std::optional<HomographyFit> fit_homography(const Pixels& first,
                                            const Pixels& second,
                                            double threshold_px,
                                            std::uint64_t seed) {
  if (first.size() < 8) return std::nullopt;
  // Similarity that normalises the pixels of both views to about [-1, 1] (H & Z, section 4.4).
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : first) box.extend(p);
  const double scale = 2.0 / std::max(1.0, box.diagonal().norm());
  Eigen::Matrix3d N = Eigen::Matrix3d::Identity() * scale;
  N.topRightCorner<2, 1>() = -scale * box.center();
  N(2, 2) = 1.0;
  const auto scaled = [&](const Pixels& pixels) {
    Pixels result;
    result.reserve(pixels.size());
    for (const Eigen::Vector2d& p : pixels) result.emplace_back(scale * (p - box.center()));
    return result;
  };
  const Pixels a = scaled(first);
  const Pixels b = scaled(second);
  const double sigma = threshold_px * scale / std::sqrt(kChi2Point);
  std::mt19937_64 rng(seed);
  const Model model = refined_homography(ransac_homography(a, b, sigma, rng), a, b, sigma);
  if (model.score <= 0.0) return std::nullopt;
  HomographyFit fit;
  fit.H_second_first = N.inverse() * model.matrix * N;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if ((transfer(fit.H_second_first, first[i]) - second[i]).norm() <= threshold_px) ++fit.inliers;
  }
  return fit;
}

std::vector<TwoViewReconstruction> reconstruct_two_view(const PinholeCamera& camera,
                                                        const Pixels& first,
                                                        const Pixels& second,
                                                        const TwoViewOptions& options) {
  if (static_cast<int>(first.size()) < options.min_points) return {};
  const Pixels a = normalised(camera, first);
  const Pixels b = normalised(camera, second);
  const double sigma = options.sigma_px / camera.fx_px;
  std::mt19937_64 rng(options.seed);
  const Model plane = refined_homography(ransac_homography(a, b, sigma, rng), a, b, sigma);
  const Model general =
      options.five_point ? five_point_essential(a, b, sigma) : ransac_essential(a, b, sigma, rng);
  if (plane.score <= 0.0 && general.score <= 0.0) return {};
  const bool planar =
      options.consider_plane && plane.score > kPlanarRatio * (plane.score + general.score);
  const std::vector<Pose> motions =
      planar ? motions_of_homography(plane.matrix) : motions_of_essential(general.matrix);
  std::vector<TwoViewReconstruction> tried;
  tried.reserve(motions.size());
  for (const Pose& T_second_first : motions) {
    tried.push_back(triangulate_all(T_second_first, a, b, 2.0 * sigma, options.parallax_share));
    tried.back().planar = planar;
  }
  std::stable_sort(tried.begin(), tried.end(), [](const auto& x, const auto& y) {
    return x.good_count > y.good_count;
  });
  if (tried.empty() || tried[0].good_count < options.min_points ||
      tried[0].good_count < options.min_good_share * static_cast<double>(first.size()) ||
      tried[0].parallax_rad < options.min_parallax_rad) {
    return {};
  }
  const double alike = kMostAlike * tried[0].good_count;
  std::erase_if(tried, [alike](const auto& motion) { return motion.good_count <= alike; });
  const bool told_apart = tried.size() == 1 || (planar && tried.size() == 2);
  return told_apart ? tried : std::vector<TwoViewReconstruction>{};
}

}  // namespace overfly::odometry
