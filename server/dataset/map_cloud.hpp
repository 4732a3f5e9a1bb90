// The sparse map that an estimator reported during its run.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/motion/estimate.hpp"
#include "core/result.hpp"

namespace overfly::server {

/// Accumulates map points over the frames. Estimators move points as they refine them and give them
/// no ids. Of all points that fall into one cell of the grid, only the last is kept. A cell is 0.5
/// % of the map's first scene depth wide; without a depth only equal points are merged.
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
/// @param comment  one line
/// Errors: kIo.
[[nodiscard]] Status write_ply(const std::filesystem::path& file,
                               const std::vector<Eigen::Vector3f>& points,
                               const std::string& comment);

}  // namespace overfly::server
