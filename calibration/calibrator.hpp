// Calibrates a camera from a stream of its images, one at a time: from a folder, a log or a live
// camera.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "calibration/board.hpp"
#include "calibration/calibration.hpp"
#include "calibration/coverage.hpp"
#include "calibration/view.hpp"
#include "core/camera/image.hpp"
#include "core/result.hpp"

namespace overfly::calibration {

enum class ViewVerdict {
  kTaken,
  kNoBoard,        ///< the board is not in the image, or not completely
  kNearDuplicate,  ///< too similar to a view that was taken
  kEnough,         ///< kMostViews were taken; the image was not searched
};

/// "taken", "no board", "near duplicate", "enough views".
[[nodiscard]] const char* to_string(ViewVerdict verdict);

struct CalibratorOptions {
  Board board;
  LensChoice lens;
  /// Takes boards that look the same after half a turn; the poses of views may then be wrong by
  /// half a turn (Board::half_turn_symmetric).
  bool accept_symmetric = false;
};

class Calibrator {
 public:
  /// A view is a near duplicate if its corners are, on average, closer to those of a taken view
  /// than this part of the image's diagonal. A board held still in front of a live camera then
  /// counts once.
  static constexpr double kDuplicateShift = 0.01;

  /// Errors: kInvalidArgument for a board outside its limits, or one that looks the same after half
  /// a turn.
  static Result<Calibrator> create(const CalibratorOptions& options);

  /// Searches the board in an image and takes the view if it adds something.
  /// @param image  8-bit grey; the first view that is taken decides the size
  /// @param name   of the image, for the result
  /// Errors: as detect_board; kInvalidArgument for an image of another size.
  [[nodiscard]] Result<ViewVerdict> add(const Image& image, const std::string& name);

  [[nodiscard]] const std::vector<BoardView>& views() const { return views_; }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Of the views taken so far.
  [[nodiscard]] std::vector<CoverageBar> coverage() const { return coverage_bars(measures_); }
  /// Errors: as calibrate.
  [[nodiscard]] Result<Calibration> solve() const;

 private:
  explicit Calibrator(const CalibratorOptions& options) : options_(options) {}

  CalibratorOptions options_;
  PinholeCamera size_{0, 0, 0.0, 0.0, 0.0, 0.0};
  std::vector<BoardView> views_;
  std::vector<ViewMeasures> measures_;
  std::vector<std::string> names_;
};

}  // namespace overfly::calibration
