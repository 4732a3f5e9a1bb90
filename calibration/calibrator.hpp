// Calibrates a camera from a stream of its images, one at a time: from a folder, a log or a live
// camera.
#pragma once

#include <cstddef>
#include <optional>
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
  kMoving,         ///< of a live camera: the board moves, which smears its corners
  kNothingNew,     ///< of a live camera: place, size and tilt are near those of a view
  kNotAsked,       ///< Capture::kNone
  kEnough,         ///< as many views as allowed were taken; the image was not searched
};

/// "taken", "no board", "near duplicate", "board moves", "nothing new", "not asked for", "enough
/// views".
[[nodiscard]] const char* to_string(ViewVerdict verdict);

struct CalibratorOptions {
  Board board;
  LensChoice lens;
  /// Takes boards that look the same after half a turn; the poses of views may then be wrong by
  /// half a turn (Board::half_turn_symmetric).
  bool accept_symmetric = false;
  /// The images are those of a live camera. A view is then taken only if it adds to the coverage
  /// (kLeastNovelty) and the board is held still (kMostMotion).
  bool live = false;
  std::size_t most_views = kMostViews;  ///< in [kLeastViews, kMostViews]
};

/// Which images give a view.
enum class Capture {
  kUseful,  ///< by the rules of CalibratorOptions
  kNow,     ///< any that shows the board and is no near duplicate
  kNone,    ///< none: the image is only searched
};

class Calibrator {
 public:
  /// A view is a near duplicate if its corners are, on average, closer to those of a taken view
  /// than this part of the image's diagonal. A board held still in front of a live camera then
  /// counts once.
  static constexpr double kDuplicateShift = 0.01;

  /// A view of a live camera is new if its measures differ from those of each view by this in sum
  /// (as ROS's camera_calibration).
  static constexpr double kLeastNovelty = 0.2;
  /// Of the corners between two images of a live camera, part of the image's diagonal.
  static constexpr double kMostMotion = 0.004;

  /// Errors: kInvalidArgument for a board outside its limits, or one that looks the same after half
  /// a turn.
  static Result<Calibrator> create(const CalibratorOptions& options);

  /// Searches the board in an image and takes the view if it adds something.
  /// @param image  8-bit grey; the first view that is taken decides the size
  /// @param name   of the image, for the result
  /// Errors: as detect_board; kInvalidArgument for an image of another size.
  [[nodiscard]] Result<ViewVerdict> add(const Image& image,
                                        const std::string& name,
                                        Capture capture = Capture::kUseful);
  /// What the last image shows of the board; empty if nothing, and before the first.
  [[nodiscard]] const std::optional<BoardView>& seen() const { return seen_; }
  [[nodiscard]] const CalibratorOptions& options() const { return options_; }
  /// Size of the views' images; its intrinsics mean nothing. 0 x 0 px before the first view.
  [[nodiscard]] const PinholeCamera& size() const { return size_; }

  [[nodiscard]] const std::vector<BoardView>& views() const { return views_; }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Of the views taken so far.
  [[nodiscard]] std::vector<CoverageBar> coverage() const { return coverage_bars(measures_); }
  /// Errors: as calibrate.
  [[nodiscard]] Result<Calibration> solve() const;

 private:
  explicit Calibrator(const CalibratorOptions& options) : options_(options) {}
  [[nodiscard]] ViewVerdict verdict_on(const BoardView& view,
                                       const ViewMeasures& measures,
                                       double diagonal_px,
                                       Capture capture) const;

  CalibratorOptions options_;
  PinholeCamera size_{0, 0, 0.0, 0.0, 0.0, 0.0};
  std::optional<BoardView> seen_;
  std::optional<BoardView> before_;  ///< the image before the last one
  std::vector<BoardView> views_;
  std::vector<ViewMeasures> measures_;
  std::vector<std::string> names_;
};

}  // namespace overfly::calibration
