// One calibration at work: searches images for the board on a thread of its own, keeps useful
// views, and estimates the camera when it is asked to.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "calibration/calibrator.hpp"
#include "core/result.hpp"
#include "server/calibration/session/board_images.hpp"
#include "server/calibration/session/image_sources.hpp"
#include "server/calibration/session/session_state.hpp"

namespace overfly::server {

/// A session keeps this many views, each with a JPEG of some 100 kB.
inline constexpr std::size_t kMostSessionViews = 120;

/// Opens the source of images, on the session's thread.
using OpenBoardImages =
    std::function<Result<std::unique_ptr<BoardImages>>(const std::atomic<bool>* cancel)>;

struct SessionRequest {
  std::string source;  ///< for the result
  calibration::CalibratorOptions calibrator;
  OpenBoardImages open;                     ///< empty: the client sends the images
  std::function<void()> begin_thread = {};  ///< called first on the session's thread
  /// A live camera is let go when nobody has looked at the session for so long.
  std::chrono::milliseconds patience{120'000};
};

/// Thread-safe.
class CalibrationSession {
 public:
  /// Errors: as Calibrator::create; kInternal if no thread can be started.
  static Result<std::shared_ptr<CalibrationSession>> begin(SessionRequest request);
  /// Waits for the image or the estimate in progress.
  ~CalibrationSession();
  CalibrationSession(const CalibrationSession&) = delete;
  CalibrationSession& operator=(const CalibrationSession&) = delete;

  [[nodiscard]] SessionState state() const;
  [[nodiscard]] const calibration::CalibratorOptions& options() const { return options_; }
  [[nodiscard]] const std::string& source() const { return source_; }
  [[nodiscard]] bool takes_uploads() const { return uploads_ != nullptr; }

  /// @param file  a PNG or JPEG file. Errors: kConflict as UploadedImages, or if the session has
  /// another source.
  [[nodiscard]] Status upload(std::string name, std::vector<std::uint8_t> file);
  /// Useful views are taken by themselves, or only when capture() asks.
  void set_automatic(bool automatic);
  /// Takes the next image that shows the board. Errors: kConflict if no more images come.
  [[nodiscard]] Status capture();
  /// Ends the source. The views stay.
  void finish();
  /// Forgets all views and the estimate.
  void clear();
  /// Estimates the camera from the views that are not left out; the result is in a later state.
  /// Errors: kInvalidArgument for a view that does not exist; kConflict with fewer than
  /// kLeastViews.
  [[nodiscard]] Status solve(const calibration::LensChoice& lens, std::set<std::size_t> left_out);

  /// The session ends soon. It may be destroyed without much waiting when over() is true.
  void cancel();
  [[nodiscard]] bool over() const { return over_; }
  /// Somebody looks at it: it goes on.
  void touch();
  [[nodiscard]] std::chrono::milliseconds untouched_for() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct SolveRequest {
    calibration::LensChoice lens;
    std::set<std::size_t> left_out;
  };
  CalibrationSession(SessionRequest request, calibration::Calibrator calibrator);
  void run();
  void work();
  void open_source();
  /// Searches the next image. Waits for it for a moment.
  void take_next();
  void search(const BoardImage& image);
  /// Puts an image into the state. @param reason  empty: it was taken
  void show(const BoardImage& image, const std::string& reason);
  [[nodiscard]] calibration::Capture wanted_capture();
  void start_again();
  void end_source(const std::string& error);
  void wait_for_request();
  [[nodiscard]] bool nobody_looks() const;
  void solve_now(const SolveRequest& request);
  [[nodiscard]] std::optional<SolveRequest> take_request();
  [[nodiscard]] Result<SessionSolution> estimate(const SolveRequest& request) const;
  template <typename Change>
  void change(const Change& change) {
    const std::lock_guard lock(mutex_);
    change(state_);
    ++state_.revision;
  }

  const std::string source_;
  const calibration::CalibratorOptions options_;
  const OpenBoardImages open_;
  const std::function<void()> begin_thread_;
  const std::chrono::milliseconds patience_;
  std::shared_ptr<UploadedImages> uploads_;  ///< null: the session opens its source itself

  std::atomic<bool> cancel_{false};
  std::atomic<bool> over_{false};
  std::atomic<Clock::time_point> touched_;
  mutable std::mutex mutex_;
  std::condition_variable wanted_;
  SessionState state_;
  bool capture_now_ = false;
  bool clear_ = false;
  bool finish_ = false;
  std::optional<SolveRequest> solve_;

  // Used by the session's thread only.
  calibration::Calibrator calibrator_;
  std::shared_ptr<BoardImages> images_;
  std::optional<CameraModel> truth_;
  std::int64_t next_number_ = 0;
  std::int64_t solutions_ = 0;
  std::thread thread_;  ///< last: it uses all others
};

}  // namespace overfly::server
