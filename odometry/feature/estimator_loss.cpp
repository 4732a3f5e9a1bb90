// Handling of lost maps, and the scale of a new map.
#include <algorithm>
#include <sstream>
#include <utility>

#include "odometry/feature/estimator.hpp"
#include "odometry/shell/stage_stopwatch.hpp"

namespace overfly::odometry::feature {
namespace {

constexpr double kGiveUpS = 3.0;
/// An image counts for at most this time of the search: it says nothing about a gap before it.
constexpr double kSearchedByOneImageS = 1.0;
/// A map with fewer keyframes is not kept for relocalisation.
constexpr int kYoungMap = 6;
/// Time after a loss during which the predicted pose is still tried.
constexpr double kExtrapolateS = 1.5;
/// Interval between searches for the old map [s]; each costs as much as several frames.
constexpr double kLookForOldMapS = 1.0;

}  // namespace

void FeatureOdometry::lose() {
  state_ = TrackingState::kLost;
  lost_at_ns_ = previous_->t_ns;
  blind_search_s_ = 0.0;
  if (static_cast<int>(map().keyframes().size()) < kYoungMap) start_over();
}

void FeatureOdometry::start_over() {
  keep_old_map();
  motion_.reset();
  parts_->initialiser.reset();
  parts_->descriptor_initialiser.reset();
  state_ = TrackingState::kInitialising;
  m_per_unit_.reset();
  map_id_ = ++last_map_id_;
}

void FeatureOdometry::search(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome) {
  const StageStopwatch stopwatch(estimate.timing_ms, "relocalisation");
  const double lost_s = static_cast<double>(frame.t_ns - lost_at_ns_) * 1e-9;
  if (lost_s < kExtrapolateS) outcome.tracked = track_map(frame);
  if (!outcome.tracked.tracked && shows_something(frame.pyramid)) {
    blind_search_s_ +=
        std::min(static_cast<double>(frame.t_ns - previous_->t_ns) * 1e-9, kSearchedByOneImageS);
    RelocaliserOptions options;
    options.seed = parameters_.seed + static_cast<std::uint64_t>(frame.index);
    const Relocalisation found = relocalise(camera_, options, frame.pyramid.level(0), orb_, map());
    estimate.counters["relocalisation_matches"] = found.matches;
    if (found.T_camera_vo) {
      outcome.tracked = parts_->tracker.track(frame.pyramid, *found.T_camera_vo, 2, map());
    }
  }
  if (outcome.tracked.tracked) {
    motion_.reset();
    accept(frame, estimate, outcome);
  } else if (blind_search_s_ > kGiveUpS) {
    start_over();
  }
}

/// Stores the current map as the old map. Of two, the one with more keyframes is kept; a young map
/// never. The height at which it was lost is known if its units are metres.
void FeatureOdometry::keep_old_map() {
  const int keyframes = map().keyframes().empty() ? 0 : map().newest().id + 1;
  if (m_per_unit_ && keyframes >= kYoungMap && map().newest().plane.holds) {
    known_height_m_ = height_above_ground() * *m_per_unit_;
  }
  const int kept = old_map_ ? old_map_->map.newest().id + 1 : kYoungMap - 1;
  Map present = parts_->keeper.release();
  if (keyframes > kept) old_map_ = OldMap{std::move(present), map_id_, m_per_unit_};
}

/// Searches for the old map now and then while a new one is built and tracked.
bool FeatureOdometry::rejoin_old_map(const FrameImage& frame,
                                     VoEstimate& estimate,
                                     Outcome& outcome) {
  const double since_s = static_cast<double>(frame.t_ns - looked_for_old_map_at_ns_) * 1e-9;
  if (!old_map_ || since_s < kLookForOldMapS || !shows_something(frame.pyramid)) return false;
  const StageStopwatch stopwatch(estimate.timing_ms, "relocalisation");
  looked_for_old_map_at_ns_ = frame.t_ns;
  RelocaliserOptions options;
  options.seed = parameters_.seed + static_cast<std::uint64_t>(frame.index);
  const Relocalisation found =
      relocalise(camera_, options, frame.pyramid.level(0), orb_, old_map_->map);
  if (!found.T_camera_vo) return false;
  TrackResult tracked = parts_->tracker.track(frame.pyramid, *found.T_camera_vo, 2, old_map_->map);
  if (!tracked.tracked) return false;
  std::ostringstream line;
  line << "recovered map " << old_map_->map_id;
  if (map_id_ != old_map_->map_id) line << ", which replaces map " << map_id_;
  log_.add(line.str());
  parts_->keeper.adopt(std::move(old_map_->map));
  map_id_ = old_map_->map_id;
  m_per_unit_ = old_map_->m_per_unit;
  old_map_.reset();
  parts_->initialiser.reset();
  parts_->descriptor_initialiser.reset();
  motion_.reset();
  outcome.tracked = std::move(tracked);
  accept(frame, estimate, outcome);
  return true;
}

/// Height of the newest keyframe, in map units.
double FeatureOdometry::height_above_ground() const {
  return 1.0 / map().newest().plane.coefficients.norm();
}

/// Scales the units to metres by the known height above the ground plane: for the first map the
/// given height, later the height at which the last map in metres was lost.
void FeatureOdometry::find_scale() {
  if (known_height_m_ <= 0.0) return;
  const Keyframe& first = map().keyframes().begin()->second;
  if (!first.plane.holds) {
    log_.add(
        "the height above ground is known, but no ground plane was found: units are not metres");
    return;
  }
  // The plane n.X = 1 is at distance 1 / |n|.
  m_per_unit_ = known_height_m_ / (1.0 / first.plane.coefficients.norm());
  if (map_id_ == 0) return;
  std::ostringstream line;
  line << "map " << map_id_ << " is scaled by the last known height above ground, "
       << known_height_m_ << " m";
  log_.add(line.str());
}

}  // namespace overfly::odometry::feature
