#include "odometry/feature/start/initialiser.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace overfly::odometry::feature {
namespace {

constexpr double kPlaneThresholdPx = 3.0;
constexpr double kMaxOffsetStepPx = 4.0;
constexpr float kMinCorrelation = 0.85F;
constexpr int kCoarseTracks = 200;
/// A track that moved less while the image moved by a hundredth of its focal length counts as
/// static.
constexpr double kStillPx = 1.0;
constexpr double kLeastStillShare = 0.05;
/// First maps with residuals up to this [sigmas] count as noise-free. Measured: 0.03 to 0.11 with
/// noise of 1.5 grey levels, 0.41 with 10.
constexpr double kUsualRmsSigma = 0.14;
/// Maximum factor by which noise increases the required parallax and the patience.
constexpr double kMostNoise = 4.0;
constexpr double kLongestWaitS = 6.0;

}  // namespace

Initialiser::Initialiser(const PinholeCamera& camera, const InitialiserOptions& options)
    : camera_(camera), options_(options) {}

void Initialiser::reset() {
  forget();
  given_up_.reset();
}

void Initialiser::forget() {
  first_.reset();
  lapsed_.clear();
  patient_ = false;
  tracks_.clear();
  origin_.clear();
  snapshots_.clear();
}

void Initialiser::start(const FrameImage& frame, OrbExtractor& orb) {
  forget();
  first_ = frame;
  frames_ = 0;
  snapshot_every_ = options_.snapshot_every;
  H_now_first_.setIdentity();
  H_step_.setIdentity();
  for (const Corner& corner : orb.detect(frame.pyramid.level(0))) {
    if (frame.pyramid.burnt_at(corner.pixel)) continue;
    const auto level = textured_level(frame.pyramid,
                                      corner.pixel,
                                      patch_level_of(corner.scale_level, orb.scale_factor()),
                                      options_.coarsest_patch_level);
    if (!level) continue;
    Track& track = tracks_.emplace_back();
    track.corner = corner;
    track.patch_level = *level;
    track.pixel = corner.pixel;
    origin_.push_back(tracks_.size() - 1);
  }
  corner_count_ = tracks_.size();
  if (static_cast<int>(corner_count_) < options_.min_tracks) forget();
}

/// Updates H for the frame with few patches at coarse levels.
bool Initialiser::follow_coarsely(const FrameImage& frame, Eigen::Matrix3d& H) const {
  const std::size_t stride = std::max<std::size_t>(1, tracks_.size() / kCoarseTracks);
  const int coarsest = frame.pyramid.level_count() - 1;
  for (int level = coarsest; level >= 1; --level) {
    const Eigen::Matrix3d H_first_now = H.inverse();
    std::vector<Eigen::Vector2d> from;
    std::vector<Eigen::Vector2d> to;
    for (std::size_t i = 0; i < tracks_.size(); i += stride) {
      const Eigen::Vector2d& pixel = tracks_[i].corner.pixel;
      const Eigen::Vector2d start = transfer(H, pixel);
      const auto patch =
          make_template(first_->pyramid, pixel, warp_around(H_first_now, start), level);
      if (!patch) continue;
      const auto match = align_patch(frame.pyramid, *patch, start + tracks_[i].offset);
      if (!match || match->correlation < kMinCorrelation) continue;
      from.push_back(pixel);
      to.push_back(match->pixel - tracks_[i].offset);
    }
    const double threshold = kPlaneThresholdPx * std::ldexp(0.5, level) + 1.0;
    const auto fit = fit_homography(from, to, threshold, options_.seed);
    if (fit && fit->inliers >= 20 && fit->inliers * 3 > static_cast<int>(from.size())) {
      H = fit->H_second_first;
    } else if (level == 1) {
      return false;
    }
  }
  return true;
}

bool Initialiser::follow(const FrameImage& frame) {
  Eigen::Matrix3d H = H_step_ * H_now_first_;
  if (!follow_coarsely(frame, H)) return false;
  std::vector<Track> alive;
  std::vector<std::size_t> origin;
  std::vector<Lapsed> lapsed;
  const auto look_for = [&](const Track& track, std::size_t of) {
    if (const auto seen = found(track, frame, H)) {
      alive.push_back(*seen);
      origin.push_back(of);
    } else {
      lapsed.push_back({track, of});
    }
  };
  for (std::size_t i = 0; i < tracks_.size(); ++i) look_for(tracks_[i], origin_[i]);
  patient_ = patient_ || !enough(alive);
  if (patient_) {
    for (const auto& [track, of] : lapsed_) look_for(track, of);
    if (!enough(alive)) return false;
    lapsed_ = std::move(lapsed);
  } else {
    lapsed_.insert(lapsed_.end(), lapsed.begin(), lapsed.end());
  }
  std::vector<Eigen::Vector2d> from;
  std::vector<Eigen::Vector2d> to;
  for (const Track& track : alive) {
    from.push_back(track.corner.pixel);
    to.push_back(track.pixel);
  }
  const auto fit = fit_homography(from, to, kPlaneThresholdPx, options_.seed);
  if (!fit) return false;
  H_step_ = fit->H_second_first * H_now_first_.inverse();
  H_now_first_ = fit->H_second_first;
  for (Track& track : alive)
    track.offset = track.pixel - transfer(H_now_first_, track.corner.pixel);
  tracks_ = std::move(alive);
  origin_ = std::move(origin);
  return true;
}

/// Finds a track's patch near the position predicted from the plane and its offset; empty if
/// missed.
std::optional<Initialiser::Track> Initialiser::found(const Track& track,
                                                     const FrameImage& frame,
                                                     const Eigen::Matrix3d& H) const {
  const Eigen::Vector2d on_plane = transfer(H, track.corner.pixel);
  const auto patch = make_template(
      first_->pyramid, track.corner.pixel, warp_around(H.inverse(), on_plane), track.patch_level);
  if (!patch) return std::nullopt;
  const Eigen::Vector2d start = on_plane + track.offset;
  const auto match = align_patch(frame.pyramid, *patch, start);
  if (!match || match->correlation < kMinCorrelation ||
      (match->pixel - start).norm() > std::ldexp(kMaxOffsetStepPx, track.patch_level)) {
    return std::nullopt;
  }
  Track seen = track;
  seen.pixel = match->pixel;
  return seen;
}

/// Whether the tracks are numerous and widespread enough for a usable map.
bool Initialiser::enough(const std::vector<Track>& tracks) const {
  if (static_cast<int>(tracks.size()) < options_.min_tracks ||
      2 * tracks.size() < corner_count_ / 2) {
    return false;
  }
  CellGrid grid = CellGrid::over(camera_.width_px, camera_.height_px, options_.cells);
  for (const Track& track : tracks) grid.marked[grid.index(track.pixel)] = 1;
  return std::count(grid.marked.begin(), grid.marked.end(), 1) >= options_.min_cells;
}

void Initialiser::remember(const FrameImage& frame) {
  Snapshot snapshot;
  snapshot.frame = frame;
  snapshot.pixels.resize(corner_count_);
  for (std::size_t i = 0; i < tracks_.size(); ++i) snapshot.pixels[origin_[i]] = tracks_[i].pixel;
  snapshots_.push_back(std::move(snapshot));
  if (static_cast<int>(snapshots_.size()) <= options_.max_snapshots) return;
  // A standing camera may wait for long: keep the views spread over the whole wait.
  std::vector<Snapshot> thinned;
  for (std::size_t i = 1; i < snapshots_.size(); i += 2) {
    thinned.push_back(std::move(snapshots_[i]));
  }
  snapshots_ = std::move(thinned);
  snapshot_every_ *= 2;
}

double Initialiser::median_motion_px() const {
  std::vector<double> motion;
  motion.reserve(tracks_.size());
  for (const Track& track : tracks_) motion.push_back((track.pixel - track.corner.pixel).norm());
  const auto middle = motion.begin() + static_cast<std::ptrdiff_t>(motion.size() / 2);
  std::nth_element(motion.begin(), middle, motion.end());
  return *middle;
}

bool Initialiser::process(const FrameImage& frame, OrbExtractor& orb, Map& map) {
  if (!first_) {
    start(frame, orb);
    return false;
  }
  if (!follow(frame)) {
    given_up_ = std::move(first_);
    start(frame, orb);
    return false;
  }
  ++frames_;
  const bool tried = frames_ % options_.attempt_every == 0 &&
                     median_motion_px() > options_.min_motion_rad * camera_.fx_px;
  if (tried && reconstruct(frame, orb, map)) {
    reset();
    return true;
  }
  if (frames_ % snapshot_every_ == 0) remember(frame);
  return false;
}

/// Uses all tracks first; then without those that do not move in the moving image (dirt on the
/// lens, parts of the aircraft).
bool Initialiser::reconstruct(const FrameImage& frame, OrbExtractor& orb, Map& map) {
  std::vector<std::size_t> all(tracks_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (reconstruct_from(all, frame, orb, map)) return true;
  std::vector<std::size_t> moving;
  for (const std::size_t i : all) {
    if ((tracks_[i].pixel - tracks_[i].corner.pixel).norm() > kStillPx) moving.push_back(i);
  }
  const double still_share =
      1.0 - static_cast<double>(moving.size()) / static_cast<double>(all.size());
  return still_share > kLeastStillShare && reconstruct_from(moving, frame, orb, map);
}

bool Initialiser::reconstruct_from(const std::vector<std::size_t>& chosen,
                                   const FrameImage& frame,
                                   OrbExtractor& orb,
                                   Map& map) {
  std::vector<Eigen::Vector2d> from;
  std::vector<Eigen::Vector2d> to;
  for (const std::size_t i : chosen) {
    from.push_back(tracks_[i].corner.pixel);
    to.push_back(tracks_[i].pixel);
  }
  TwoViewOptions options;
  const double waited_s = static_cast<double>(frame.t_ns - first_->t_ns) * 1e-9;
  options.min_parallax_rad =
      waited_s > options_.patience_s ? options_.least_parallax_rad : options_.min_parallax_rad;
  options.consider_plane = options_.planar_start;
  options.seed = options_.seed;
  std::vector<FirstMapInput> inputs;
  double parallax_rad = 0.0;
  for (const TwoViewReconstruction& motion : reconstruct_two_view(camera_, from, to, options)) {
    inputs.push_back(input_of(motion, chosen, frame));
    parallax_rad = std::max(parallax_rad, motion.parallax_rad);
  }
  const auto best = choose_first_map(camera_, std::move(inputs));
  if (!best) return false;
  // Depth accuracy depends on the ratio of parallax to noise, which the residuals estimate.
  const double noise = std::clamp(best->solved.rms_sigma / kUsualRmsSigma, 1.0, kMostNoise);
  const double least_rad = waited_s > noise * options_.patience_s ? options_.least_parallax_rad
                                                                  : options_.min_parallax_rad;
  if (parallax_rad < noise * least_rad && waited_s < kLongestWaitS) return false;
  fill_first_map(camera_, best->input, best->solved, orb, map);
  return true;
}

FirstMapInput Initialiser::input_of(const TwoViewReconstruction& motion,
                                    const std::vector<std::size_t>& chosen,
                                    const FrameImage& frame) const {
  FirstMapInput input;
  input.first = &*first_;
  input.last = &frame;
  for (std::size_t pair = 0; pair < chosen.size(); ++pair) {
    if (motion.good[pair] == 0) continue;
    const std::size_t i = chosen[pair];
    FirstMapPoint& point = input.points.emplace_back();
    point.corner = tracks_[i].corner;
    point.patch_level = tracks_[i].patch_level;
    point.p_first = motion.points_first[pair];
    point.last_pixel = tracks_[i].pixel;
    for (const Snapshot& snapshot : snapshots_) {
      point.between_pixels.push_back(snapshot.pixels[origin_[i]]);
    }
  }
  for (const Snapshot& snapshot : snapshots_) input.between.push_back(&snapshot.frame);
  input.T_last_first = motion.T_second_first;
  return input;
}

}  // namespace overfly::odometry::feature
