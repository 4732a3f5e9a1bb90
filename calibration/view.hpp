// What an image shows of a board.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace overfly::calibration {

struct BoardCorner {
  int id = 0;                                       ///< as Board::corner_m
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< pixel centres at integers
};

/// The visible corners of a board in one image, by increasing id.
struct BoardView {
  std::vector<BoardCorner> corners;
};

}  // namespace overfly::calibration
