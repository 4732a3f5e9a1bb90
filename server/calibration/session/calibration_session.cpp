#include "server/calibration/session/calibration_session.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/barrier.hpp"
#include "core/camera/halved_image.hpp"
#include "server/files/jpeg.hpp"

namespace overfly::server {
namespace {

using calibration::BoardView;
using calibration::Calibrator;
using calibration::CalibratorOptions;
using calibration::Capture;
using calibration::LensChoice;
using calibration::ViewVerdict;
using std::chrono::milliseconds;

constexpr int kPreviewQuality = 80;
/// How long the thread waits for an image or a request before it looks whether it should end.
constexpr milliseconds kTurn{100};

Error conflict(const std::string& what) { return {ErrorCode::kConflict, what}; }

JpegBytes preview_of(const Image& image) {
  const auto small = halved_to_fit(std::make_shared<const Image>(image), kPreviewWidthPx);
  auto jpeg = encode_jpeg(*small, kPreviewQuality);
  if (!jpeg) return nullptr;
  return std::make_shared<const std::vector<std::uint8_t>>(std::move(*jpeg));
}

CalibratorOptions session_options(CalibratorOptions options, bool moving) {
  options.live = moving;
  options.most_views = kMostSessionViews;
  return options;
}

}  // namespace

const char* to_string(SessionPhase phase) {
  switch (phase) {
    case SessionPhase::kOpening:
      return "opening";
    case SessionPhase::kTaking:
      return "taking";
    case SessionPhase::kSolving:
      return "solving";
    case SessionPhase::kWaiting:
      return "waiting";
    case SessionPhase::kFailed:
      break;
  }
  return "failed";
}

std::shared_ptr<const SearchedImage> find_image(const SessionState& state, std::int64_t number) {
  for (const auto& image : state.recent) {
    if (image->number == number) return image;
  }
  for (const auto& image : state.views) {
    if (image->number == number) return image;
  }
  return nullptr;
}

Result<std::shared_ptr<CalibrationSession>> CalibrationSession::begin(SessionRequest request) {
  auto calibrator = Calibrator::create(session_options(request.calibrator, false));
  if (!calibrator) return calibrator.error();
  std::shared_ptr<CalibrationSession> session(
      new CalibrationSession(std::move(request), std::move(*calibrator)));
  try {
    session->thread_ = std::thread([raw = session.get()] { raw->run(); });
  } catch (const std::system_error& failure) {
    return Error{ErrorCode::kInternal,
                 std::string("a calibration cannot start its thread: ") + failure.what()};
  }
  return session;
}

CalibrationSession::CalibrationSession(SessionRequest request, Calibrator calibrator)
    : source_(std::move(request.source)),
      options_(request.calibrator),
      open_(std::move(request.open)),
      begin_thread_(std::move(request.begin_thread)),
      patience_(request.patience),
      uploads_(open_ ? nullptr : std::make_shared<UploadedImages>()),
      touched_(Clock::now()),
      calibrator_(std::move(calibrator)) {
  state_.lens = options_.lens;
  state_.coverage = calibrator_.coverage();
}

CalibrationSession::~CalibrationSession() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

SessionState CalibrationSession::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

Result<bool> CalibrationSession::upload(std::string name, std::vector<std::uint8_t> file) {
  if (!uploads_) return conflict("the images of this session come from " + source_);
  return uploads_->push(std::move(name), std::move(file));
}

void CalibrationSession::set_automatic(bool automatic) {
  change([&](SessionState& state) { state.automatic = automatic; });
}

Status CalibrationSession::capture() {
  const std::lock_guard lock(mutex_);
  if (!state_.source_open) return conflict("there are no more images");
  capture_now_ = true;
  return {};
}

void CalibrationSession::finish() {
  if (uploads_) uploads_->finish();
  const std::lock_guard lock(mutex_);
  finish_ = true;
}

void CalibrationSession::clear() {
  const std::lock_guard lock(mutex_);
  clear_ = true;
  wanted_.notify_all();
}

Status CalibrationSession::solve(const LensChoice& lens, std::set<std::size_t> left_out) {
  const std::lock_guard lock(mutex_);
  const std::size_t count = state_.views.size();
  if (!left_out.empty() && *left_out.rbegin() >= count) {
    return Error{ErrorCode::kInvalidArgument,
                 "left_out = " + std::to_string(*left_out.rbegin()) + ": must be below " +
                     std::to_string(count) + ", the number of views"};
  }
  if (count - left_out.size() < calibration::kLeastViews) {
    return conflict(std::to_string(count - left_out.size()) + " views: at least " +
                    std::to_string(calibration::kLeastViews) + " are needed");
  }
  solve_ = SolveRequest{lens, std::move(left_out)};
  wanted_.notify_all();
  return {};
}

void CalibrationSession::cancel() {
  cancel_ = true;
  const std::lock_guard lock(mutex_);
  wanted_.notify_all();
}

void CalibrationSession::touch() { touched_ = Clock::now(); }

milliseconds CalibrationSession::untouched_for() const {
  return std::chrono::duration_cast<milliseconds>(Clock::now() - touched_.load());
}

bool CalibrationSession::nobody_looks() const { return untouched_for() > patience_; }

void CalibrationSession::run() {
  (void)contained([&] { work(); },
                  [&](const char* what) {
                    (void)contained([&] { end_source(std::string("internal error: ") + what); },
                                    [](const char*) {});
                  });
  images_.reset();
  over_ = true;
}

void CalibrationSession::work() {
  if (begin_thread_) begin_thread_();
  open_source();
  while (!cancel_) {
    if (const auto request = take_request()) {
      solve_now(*request);
    } else if (images_) {
      take_next();
    } else {
      wait_for_request();
    }
  }
}

void CalibrationSession::open_source() {
  if (uploads_) {
    images_ = uploads_;
  } else {
    auto opened = open_(&cancel_);
    if (!opened) {
      end_source(opened.error().message);
      return;
    }
    images_ = std::move(*opened);
  }
  truth_ = images_->truth();
  start_again();
  change([&](SessionState& state) {
    state.phase = SessionPhase::kTaking;
    state.images_total = images_->total();
  });
}

/// A source that is not moving, or has ended, keeps its views for as long as the session.
void CalibrationSession::take_next() {
  bool finished = false;
  bool cleared = false;
  {
    const std::lock_guard lock(mutex_);
    finished = finish_ && !uploads_;
    cleared = std::exchange(clear_, false);
  }
  if (cleared) start_again();
  const bool left = !uploads_ && !images_->total() && nobody_looks();
  if (finished || left || images_->ended()) {
    end_source("");
    return;
  }
  Result<std::unique_ptr<BoardImage>> image = images_->next(kTurn);
  if (!image) {
    end_source(image.error().message);
  } else if (*image) {
    search(**image);
  }
}

void CalibrationSession::start_again() {
  auto fresh = Calibrator::create(session_options(options_, images_ && images_->moving()));
  if (fresh) calibrator_ = std::move(*fresh);
  change([&](SessionState& state) {
    solve_.reset();
    state.views.clear();
    state.left_out.clear();
    state.left_out_images.clear();
    state.images_without_view = 0;
    state.solution = nullptr;
    state.solve_error.clear();
    state.coverage = calibrator_.coverage();
  });
}

Capture CalibrationSession::wanted_capture() {
  const std::lock_guard lock(mutex_);
  if (capture_now_) return Capture::kNow;
  return state_.automatic ? Capture::kUseful : Capture::kNone;
}

void CalibrationSession::search(const BoardImage& image) {
  if (!image.image) {
    show(image, image.image.error().message);
    return;
  }
  const Status size =
      check_image_pixels(image.image->width_px, image.image->height_px, kMostBoardImagePixels);
  if (!size) {
    show({image.name, size.error()}, size.error().message);
    return;
  }
  const auto verdict = calibrator_.add(*image.image, image.name, wanted_capture());
  const bool taken = verdict && *verdict == ViewVerdict::kTaken;
  show(image, taken ? "" : verdict ? to_string(*verdict) : verdict.error().message);
}

void CalibrationSession::show(const BoardImage& image, const std::string& reason) {
  const bool taken = reason.empty();
  auto searched = std::make_shared<SearchedImage>();
  searched->number = next_number_++;
  searched->name = image.name;
  searched->verdict = taken ? to_string(ViewVerdict::kTaken) : reason;
  if (image.image) {
    searched->width_px = image.image->width_px;
    searched->height_px = image.image->height_px;
    searched->jpeg = preview_of(*image.image);
    if (const auto& seen = calibrator_.seen()) searched->corners = seen->corners;
  }
  // Of a live camera most images give no view, which says nothing.
  const bool listed = !images_->moving();
  const std::lock_guard lock(mutex_);
  ++state_.images_done;
  state_.recent.push_back(searched);
  if (state_.recent.size() > kMostRecent) state_.recent.pop_front();
  if (taken) {
    capture_now_ = false;
    state_.views.push_back(std::move(searched));
    state_.coverage = calibrator_.coverage();
  } else {
    ++state_.images_without_view;
    if (listed && state_.left_out_images.size() < kMostLeftOutListed) {
      state_.left_out_images.push_back({image.name, reason});
    }
  }
  ++state_.revision;
}

void CalibrationSession::end_source(const std::string& error) {
  if (uploads_) uploads_->finish();
  images_.reset();
  change([&](SessionState& state) {
    state.source_open = false;
    state.error = error;
    state.phase = error.empty() ? SessionPhase::kWaiting : SessionPhase::kFailed;
    // What came before a camera failed may be enough.
    const std::size_t views = state.views.size() - state.left_out.size();
    const bool more = !state.solution || state.solution->view_of.size() < views;
    if (views >= calibration::kLeastViews && more && !solve_) {
      solve_ = SolveRequest{state.lens, state.left_out};
    }
  });
}

void CalibrationSession::wait_for_request() {
  std::unique_lock lock(mutex_);
  wanted_.wait_for(lock, kTurn, [&] { return solve_ || clear_ || cancel_; });
  // Without a source nothing new would come.
  clear_ = false;
}

std::optional<CalibrationSession::SolveRequest> CalibrationSession::take_request() {
  const std::lock_guard lock(mutex_);
  if (clear_) return std::nullopt;
  return std::exchange(solve_, std::nullopt);
}

void CalibrationSession::solve_now(const SolveRequest& request) {
  SessionPhase before = SessionPhase::kWaiting;
  change([&](SessionState& state) {
    before = std::exchange(state.phase, SessionPhase::kSolving);
    state.lens = request.lens;
    state.left_out = request.left_out;
  });
  Result<SessionSolution> solution = estimate(request);
  if (solution) solution->number = ++solutions_;
  change([&](SessionState& state) {
    state.phase = before;
    state.solve_error = solution ? "" : solution.error().message;
    if (solution) state.solution = std::make_shared<const SessionSolution>(std::move(*solution));
  });
}

Result<SessionSolution> CalibrationSession::estimate(const SolveRequest& request) const {
  SessionSolution solution;
  CalibrationRecord& record = solution.record;
  record.source = source_;
  record.options = options_;
  record.options.lens = request.lens;
  record.truth = truth_;
  std::vector<BoardView> views;
  const std::vector<std::string>& names = calibrator_.names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (request.left_out.contains(i)) {
      record.left_out.push_back({names[i], "left out by the user"});
      continue;
    }
    views.push_back(calibrator_.views()[i]);
    record.names.push_back(names[i]);
    solution.view_of.push_back(i);
  }
  {
    const std::lock_guard lock(mutex_);
    record.left_out.insert(
        record.left_out.end(), state_.left_out_images.begin(), state_.left_out_images.end());
  }
  auto result = calibration::calibrate(options_.board, calibrator_.size(), request.lens, views);
  if (!result) return result.error();
  record.result = std::move(*result);
  return solution;
}

}  // namespace overfly::server
