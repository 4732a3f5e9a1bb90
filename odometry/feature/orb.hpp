// Oriented corners with binary descriptors, spread evenly over image and scales.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "odometry/feature/feature_odometry.hpp"

namespace overfly::odometry::feature {

/// 256 bits of brightness comparisons.
using Descriptor = std::array<std::uint64_t, 4>;

struct Corner {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< full resolution
  int scale_level = 0;                              ///< its size is scale_factor^level
  float response = 0.0F;                            ///< FAST score
  Eigen::Vector2i level_pixel = Eigen::Vector2i::Zero();
};

/// Square cells of an image, row-major, each with a mark.
struct CellGrid {
  double cell_px = 1.0;
  int columns = 0;
  std::vector<std::uint8_t> marked;

  /// About `cells` square cells over an image, all unmarked.
  static CellGrid over(int width_px, int height_px, int cells);
  /// @pre the pixel is in the image
  [[nodiscard]] std::size_t index(const Eigen::Vector2d& pixel) const;
  /// Whether any cell that touches the box (full resolution, clipped to the grid) is marked.
  [[nodiscard]] bool any_marked(const Eigen::Vector2d& low, const Eigen::Vector2d& high) const;
};

/// Number of differing bits, in [0, 256].
[[nodiscard]] inline int hamming_distance(const Descriptor& a, const Descriptor& b) {
  // Sums of bits in lanes of 4, 8 and 16 bits. std::popcount is a call of a function with a table
  // unless the program requires a processor with that instruction.
  constexpr std::uint64_t kPairs = 0x5555555555555555;
  constexpr std::uint64_t kNibbles = 0x3333333333333333;
  constexpr std::uint64_t kBytes = 0x0f0f0f0f0f0f0f0f;
  constexpr std::uint64_t kShorts = 0x00ff00ff00ff00ff;
  static_assert(std::tuple_size_v<Descriptor> == 4);
  const auto in_nibbles = [&](std::size_t i) {
    std::uint64_t bits = a[i] ^ b[i];
    bits -= (bits >> 1U) & kPairs;
    return (bits & kNibbles) + ((bits >> 2U) & kNibbles);
  };
  const auto in_bytes = [](std::uint64_t nibbles) {
    return (nibbles & kBytes) + ((nibbles >> 4U) & kBytes);
  };
  const std::uint64_t bytes =
      in_bytes(in_nibbles(0) + in_nibbles(1)) + in_bytes(in_nibbles(2) + in_nibbles(3));
  const std::uint64_t shorts = (bytes & kShorts) + ((bytes >> 8U) & kShorts);
  return static_cast<int>((shorts * 0x0001000100010001) >> 48U);
}

/// Detects and describes corners. An object processes one image at a time: `detect`, then
/// `describe`.
///
/// Method: FAST (Rosten and Drummond 2006) on a scale pyramid, orientation by the intensity
/// centroid and steered BRIEF (Rublee et al. 2011, ORB, sections 3 and 4; Calonder et al. 2010 for
/// the Gaussian pattern, G II). The pattern is generated once from a fixed seed.
class OrbExtractor {
 public:
  explicit OrbExtractor(const FeatureParameters& parameters);

  /// Detects corners in an 8-bit image. Each cell of each level tries the initial threshold, then
  /// the minimum, and with `low_texture` finally 2. Each level contributes its share of `features`,
  /// taken in rounds over the cells.
  /// @param wanted  searches only near marked cells; null = everywhere
  [[nodiscard]] std::vector<Corner> detect(const cv::Mat& image, const CellGrid* wanted = nullptr);
  /// Restricts detection to areas where `seen` is not 0, with the same margin to the other areas as
  /// to the image border.
  /// @param seen  CV_8U of the images' size; empty = everywhere
  void look_only_at(const cv::Mat& seen);
  /// Sets the image for `describe` without detecting corners.
  void load(const cv::Mat& image);
  /// Descriptor of a corner of the image last given to `detect` or `load`.
  [[nodiscard]] Descriptor describe(const Corner& corner);

  [[nodiscard]] double scale_factor() const { return parameters_.scale_factor; }

 private:
  [[nodiscard]] std::vector<Corner> detect_level(int level, const CellGrid* wanted) const;

  FeatureParameters parameters_;
  std::vector<double> scales_;
  std::vector<int> shares_;
  std::vector<cv::Mat> levels_;
  std::vector<cv::Mat> masks_;  ///< per level: not 0 where corners are allowed; empty = everywhere
  std::vector<cv::Mat> smoothed_;  ///< computed on first use
};

}  // namespace overfly::odometry::feature
