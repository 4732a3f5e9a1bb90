#include "odometry/feature/initialiser.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace overfly::odometry {
namespace {

constexpr double kPlaneThresholdPx = 3.0;
constexpr double kMaxOffsetStepPx = 4.0;
constexpr float kMinCorrelation = 0.85F;
constexpr int kCoarseTracks = 200;
/// Of two motions over all views the better one's residual must be less than so much of the
/// other's. Thousands of sights tell residuals apart to a few hundredths; 0.33 to 0.68 was seen in
/// flight.
constexpr double kMostAlikeResidual = 0.7;

/// A motion that two views allow, and what all views make of it.
struct Hypothesis {
  FirstMapInput input;
  FirstMap solved;
};

/// A wrong plane fits two views, but not all between them as well. Null while none stands out.
const Hypothesis* best_of(std::vector<Hypothesis>& hypotheses) {
  if (hypotheses.empty()) return nullptr;
  std::sort(hypotheses.begin(), hypotheses.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.solved.rms_sigma < b.solved.rms_sigma;
  });
  const bool told_apart =
      hypotheses.size() == 1 ||
      hypotheses[0].solved.rms_sigma < kMostAlikeResidual * hypotheses[1].solved.rms_sigma;
  return told_apart ? &hypotheses[0] : nullptr;
}

}  // namespace

int patch_level_of(int scale_level, double scale_factor) {
  const double octaves = scale_level * std::log2(scale_factor);
  return std::clamp(static_cast<int>(std::lround(octaves)), 0, 2);
}

Initialiser::Initialiser(const PinholeCamera& camera, const InitialiserOptions& options)
    : camera_(camera), options_(options) {}

void Initialiser::reset() {
  first_.reset();
  tracks_.clear();
  origin_.clear();
  snapshots_.clear();
}

void Initialiser::start(const FrameImage& frame, OrbExtractor& orb) {
  reset();
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
  if (static_cast<int>(corner_count_) < options_.min_tracks) reset();
}

/// Brings H near the frame with few patches at coarse levels.
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
  const Eigen::Matrix3d H_first_now = H.inverse();
  std::vector<Track> alive;
  std::vector<std::size_t> origin;
  std::vector<Eigen::Vector2d> from;
  std::vector<Eigen::Vector2d> to;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Track track = tracks_[i];
    const Eigen::Vector2d on_plane = transfer(H, track.corner.pixel);
    const auto patch = make_template(
        first_->pyramid, track.corner.pixel, warp_around(H_first_now, on_plane), track.patch_level);
    if (!patch) continue;
    const Eigen::Vector2d start = on_plane + track.offset;
    const auto match = align_patch(frame.pyramid, *patch, start);
    if (!match || match->correlation < kMinCorrelation ||
        (match->pixel - start).norm() > std::ldexp(kMaxOffsetStepPx, track.patch_level)) {
      continue;
    }
    track.pixel = match->pixel;
    from.push_back(track.corner.pixel);
    to.push_back(match->pixel);
    alive.push_back(track);
    origin.push_back(origin_[i]);
  }
  if (!enough(alive)) return false;
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

/// Whether so many are left, so widely spread, that they make a map worth following.
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
  // A camera that stands may wait for long: the views stay spread over the whole wait.
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

bool Initialiser::reconstruct(const FrameImage& frame, OrbExtractor& orb, Map& map) {
  std::vector<Eigen::Vector2d> from;
  std::vector<Eigen::Vector2d> to;
  for (const Track& track : tracks_) {
    from.push_back(track.corner.pixel);
    to.push_back(track.pixel);
  }
  TwoViewOptions options;
  const bool waited = static_cast<double>(frame.t_ns - first_->t_ns) * 1e-9 > options_.patience_s;
  options.min_parallax_rad = waited ? options_.least_parallax_rad : options_.min_parallax_rad;
  options.consider_plane = options_.planar_start;
  options.seed = options_.seed;
  std::vector<Hypothesis> hypotheses;
  for (const TwoViewReconstruction& motion : reconstruct_two_view(camera_, from, to, options)) {
    FirstMapInput input = input_of(motion, frame);
    auto solved = solve_first_map(camera_, input);
    if (solved) hypotheses.push_back({std::move(input), std::move(*solved)});
  }
  const Hypothesis* best = best_of(hypotheses);
  if (best == nullptr) return false;
  fill_first_map(camera_, best->input, best->solved, orb, map);
  return true;
}

FirstMapInput Initialiser::input_of(const TwoViewReconstruction& motion,
                                    const FrameImage& frame) const {
  FirstMapInput input;
  input.first = &*first_;
  input.last = &frame;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (motion.good[i] == 0) continue;
    FirstMapPoint& point = input.points.emplace_back();
    point.corner = tracks_[i].corner;
    point.patch_level = tracks_[i].patch_level;
    point.p_first = motion.points_first[i];
    point.last_pixel = tracks_[i].pixel;
    for (const Snapshot& snapshot : snapshots_) {
      point.between_pixels.push_back(snapshot.pixels[origin_[i]]);
    }
  }
  for (const Snapshot& snapshot : snapshots_) input.between.push_back(&snapshot.frame);
  input.T_last_first = motion.T_second_first;
  return input;
}

}  // namespace overfly::odometry
