// The sparse map that an estimator showed along its way.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/estimate.hpp"
#include "core/result.hpp"

namespace overfly::engine {

/// Gathers the points that are seen from frame to frame. Estimators move points as they learn more
/// of them, and give them no names: of all that came to lie in one cell of the grid the last stays.
/// A cell is 0.5 % of the map's first scene depth wide; without a depth only equal points are one.
class MapCloud {
 public:
  void add(const EstimateSample& sample, const std::vector<Eigen::Vector3f>& points_vo);

  /// Points of one map (EstimateSample::map_id), in vo units.
  [[nodiscard]] std::vector<Eigen::Vector3f> points(int map_id) const;

 private:
  struct Piece {
    double cell = 0.0;
    std::map<std::array<std::int64_t, 3>, Eigen::Vector3f> points;
  };
  std::map<int, Piece> pieces_;
};

/// Writes points as PLY (Turk 1994, text, float x y z); the file appears whole or not at all.
/// @param comment  one line. Errors: kIo.
[[nodiscard]] Status write_ply(const std::filesystem::path& file,
                               const std::vector<Eigen::Vector3f>& points,
                               const std::string& comment);

}  // namespace overfly::engine
