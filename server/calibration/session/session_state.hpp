// What a calibration session shows of itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "calibration/calibration.hpp"
#include "calibration/calibrator.hpp"
#include "calibration/coverage.hpp"
#include "calibration/view.hpp"
#include "server/calibration/calibration_record.hpp"

namespace overfly::server {

enum class SessionPhase {
  kOpening,  ///< the source
  kTaking,   ///< images are searched for the board
  kSolving,  ///< the camera is estimated
  kWaiting,  ///< the source has ended; nothing is in progress
  kFailed,   ///< the source could not be opened, or has failed
};
/// "opening", "taking", "solving", "waiting", "failed".
[[nodiscard]] const char* to_string(SessionPhase phase);

using JpegBytes = std::shared_ptr<const std::vector<std::uint8_t>>;

/// One image with the corners that were found in it, and a JPEG of at most kPreviewWidthPx.
struct SearchedImage {
  std::int64_t number = 0;  ///< of the session's images, from 0
  std::string name;
  int width_px = 0;  ///< of the image, not of the JPEG
  int height_px = 0;
  std::string verdict;  ///< "taken", or why not
  std::vector<calibration::BoardCorner> corners;
  JpegBytes jpeg;
};
inline constexpr int kPreviewWidthPx = 1280;

/// An estimate, and from which of the views it was made.
struct SessionSolution {
  std::int64_t number = 0;  ///< increases with each estimate of the session
  CalibrationRecord record;
  /// Of each entry of record.result.views: the number of the session's view.
  std::vector<std::size_t> view_of;
};

/// A copy of a session's state. Images and solutions are shared.
struct SessionState {
  std::int64_t revision = 0;  ///< increases with each change
  SessionPhase phase = SessionPhase::kOpening;
  std::string error;  ///< of a failed source; else empty
  bool automatic = true;
  bool source_open = true;  ///< more images may come
  std::size_t images_done = 0;
  std::optional<std::size_t> images_total;
  /// The newest images, the newest last: a client that was told of one may still ask for it.
  std::deque<std::shared_ptr<const SearchedImage>> recent;
  std::vector<std::shared_ptr<const SearchedImage>> views;
  std::size_t images_without_view = 0;
  std::vector<LeftOutImage> left_out_images;  ///< the first kMostLeftOutListed of them
  std::vector<calibration::CoverageBar> coverage;
  calibration::LensChoice lens;                     ///< of the last estimate that was asked for
  std::set<std::size_t> left_out;                   ///< views without part in it
  std::shared_ptr<const SessionSolution> solution;  ///< null before the first
  std::string solve_error;  ///< why the last estimate was not possible; else empty
};
inline constexpr std::size_t kMostLeftOutListed = 200;
inline constexpr std::size_t kMostRecent = 4;

/// A recent image, or one that gave a view, by its number; null if it is neither.
[[nodiscard]] std::shared_ptr<const SearchedImage> find_image(const SessionState& state,
                                                              std::int64_t number);

}  // namespace overfly::server
