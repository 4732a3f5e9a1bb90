#include "evaluation/outcome.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/time.hpp"

namespace overfly::evaluation {
namespace {

constexpr double kCompletedShare = 0.95;  // of the frames after initialisation
constexpr std::int64_t kStepNs = kNsPerS;
constexpr std::size_t kWindowSteps = 10;
constexpr double kScaleChange = 2.0;
constexpr double kWindowMinM = 1.0;  // a window with a shorter true path gives no scale
/// The estimator counts as lost if frames are missing for this long.
constexpr std::int64_t kGapNs = kNsPerS;
constexpr std::int64_t kLateStartNs = 10 * kNsPerS;
constexpr std::int64_t kLateStartShare = 10;  // one tenth of the flight
/// Lower limit, because every estimator needs some time to initialise in a short flight.
constexpr std::int64_t kShortestLateStartNs = 2 * kNsPerS;

bool has_pose(const FlownFrame& flown) {
  return flown.given && flown.sample.state == TrackingState::kTracking;
}

/// Path of truth and estimate over one second; `broken` if poses are missing in between.
struct Step {
  std::int64_t end_ns = 0;
  double truth_m = 0.0;
  double vo = 0.0;
  bool broken = false;
};

std::vector<Step> steps_of(const std::vector<MatchedPose>& matches) {
  std::vector<Step> steps;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < matches.size(); ++i) {
    const std::int64_t dt_ns = matches[i].t_ns - matches[begin].t_ns;
    if (dt_ns < kStepNs) continue;
    const MatchedPose& a = matches[begin];
    const MatchedPose& b = matches[i];
    steps.push_back({b.t_ns,
                     (b.T_world_camera.translation - a.T_world_camera.translation).norm(),
                     (b.T_vo_camera.translation - a.T_vo_camera.translation).norm(),
                     dt_ns >= 2 * kStepNs});
    begin = i;
  }
  return steps;
}

/// Scale of the estimate, vo / truth, so that an estimate that does not move has scale 0.
struct WindowScale {
  std::int64_t end_ns = 0;
  double scale = 0.0;
};

/// Of every window of ten steps in which no pose is missing and the truth moves.
std::vector<WindowScale> window_scales(const std::vector<MatchedPose>& matches) {
  const std::vector<Step> steps = steps_of(matches);
  std::vector<WindowScale> windows;
  for (std::size_t end = kWindowSteps; end <= steps.size(); ++end) {
    double truth_m = 0.0;
    double vo = 0.0;
    bool broken = false;
    for (std::size_t i = end - kWindowSteps; i < end; ++i) {
      truth_m += steps[i].truth_m;
      vo += steps[i].vo;
      broken = broken || steps[i].broken;
    }
    if (broken || truth_m < kWindowMinM) continue;
    windows.push_back({steps[end - 1].end_ns, vo / truth_m});
  }
  return windows;
}

/// Marks the frames that count as tracked, including short stretches that were never received.
std::vector<bool> held_frames(const std::vector<FlownFrame>& flown) {
  std::vector<bool> held(flown.size());
  std::size_t begin = 0;  // of the stretch of frames not received
  for (std::size_t i = 0; i < flown.size(); ++i) {
    held[i] = has_pose(flown[i]);
    if (flown[i].given) begin = i + 1;
    const bool last = i + 1 == flown.size();
    if (begin > i || begin == 0 || (!last && !flown[i + 1].given)) continue;
    const FlownFrame& before = flown[begin - 1];
    const FlownFrame& after = last ? flown[i] : flown[i + 1];
    const bool in_one_map = has_pose(before) && before.sample.map_id == after.sample.map_id;
    if (!in_one_map || !(last || has_pose(after))) continue;
    if (after.t_ns - before.t_ns >= kGapNs) continue;
    std::fill(held.begin() + static_cast<std::ptrdiff_t>(begin),
              held.begin() + static_cast<std::ptrdiff_t>(i) + 1,
              true);
  }
  return held;
}

/// Start of the last loss if the flight ends without tracking, otherwise of the first loss.
std::optional<double> loss_time_s(const std::vector<FlownFrame>& flown,
                                  const std::vector<bool>& held,
                                  std::size_t first) {
  std::optional<double> begin_s;
  bool lost = false;
  for (std::size_t i = first; i < flown.size(); ++i) {
    if (!held[i] && !lost && (!begin_s || !held.back())) begin_s = s_from_ns(flown[i].t_ns);
    lost = !held[i];
  }
  return begin_s;
}

/// Counts the ends of losses after which the estimator tracks in a map that it had tracked before.
void add_relocalisations(const std::vector<FlownFrame>& flown, Score* score) {
  score->relocalisations = 0;
  std::set<int> known_maps;
  std::size_t last = 0;  // tracked frame
  for (std::size_t i = 0; i < flown.size(); ++i) {
    if (!has_pose(flown[i])) continue;
    const bool is_known = !known_maps.insert(flown[i].sample.map_id).second;
    const bool was_lost = i > last + 1 && flown[i].t_ns - flown[last].t_ns >= kGapNs;
    if (is_known && was_lost) {
      ++*score->relocalisations;
      if (!score->relocalised_at_s) score->relocalised_at_s = s_from_ns(flown[i].t_ns);
    }
    last = i;
  }
}

/// Time of the first frame in a later map than that of the first tracked frame.
std::optional<double> reset_time_s(const std::vector<FlownFrame>& flown, std::size_t first) {
  for (std::size_t i = first; i < flown.size(); ++i) {
    if (flown[i].sample.map_id != flown[first].sample.map_id) return s_from_ns(flown[i].t_ns);
  }
  return std::nullopt;
}

/// Time in the flight of the frame with this stamp; the stamp itself if no frame has it.
std::int64_t flight_time_ns(const std::vector<FlownFrame>& flown, std::int64_t stamp_ns) {
  const auto frame = std::find_if(flown.begin(), flown.end(), [&](const FlownFrame& candidate) {
    return candidate.given && candidate.sample.t_ns == stamp_ns;
  });
  return frame == flown.end() ? stamp_ns : frame->t_ns;
}

bool starts_late(const std::vector<FlownFrame>& flown, std::size_t first) {
  const std::int64_t begin_ns = flown.front().t_ns;
  const std::int64_t share_ns = (flown.back().t_ns - begin_ns) / kLateStartShare;
  return flown[first].t_ns - begin_ns > std::clamp(share_ns, kShortestLateStartNs, kLateStartNs);
}

}  // namespace

std::optional<std::int64_t> divergence_time_ns(const std::vector<MatchedPose>& matches) {
  double smallest = INFINITY;
  double largest = 0.0;
  for (const WindowScale& window : window_scales(matches)) {
    smallest = std::min(smallest, window.scale);
    largest = std::max(largest, window.scale);
    if (largest > kScaleChange * smallest) return window.end_ns;
  }
  return std::nullopt;
}

std::optional<double> scale_change(const std::vector<MatchedPose>& matches) {
  const std::vector<WindowScale> windows = window_scales(matches);
  if (windows.empty()) return std::nullopt;
  const auto [smallest, largest] = std::minmax_element(
      windows.begin(), windows.end(), [](const WindowScale& a, const WindowScale& b) {
        return a.scale < b.scale;
      });
  return largest->scale > 0.0 ? largest->scale / smallest->scale : 1.0;
}

double kept_share(const EstimateTrack& estimate, const Options& options) {
  const std::vector<FlownFrame> flown = flown_frames(estimate, options);
  const std::vector<bool> held = held_frames(flown);
  const auto first = std::find_if(flown.begin(), flown.end(), has_pose);
  if (first == flown.end()) return 0.0;
  return static_cast<double>(std::count(held.begin(), held.end(), true)) /
         static_cast<double>(flown.end() - first);
}

std::vector<FlownFrame> flown_frames(const EstimateTrack& estimate, const Options& options) {
  std::vector<FlownFrame> flown;
  flown.reserve(std::max(options.flight.size(), estimate.samples.size()));
  int map_id = 0;
  const auto add_missing = [&](const FlightFrame& frame) {
    FlownFrame missing;
    missing.given = false;
    missing.sample.frame = frame.frame;
    missing.sample.t_ns = frame.t_ns;
    missing.sample.map_id = map_id;
    missing.t_ns = frame.t_ns;
    flown.push_back(missing);
  };
  auto next = options.flight.begin();
  for (const EstimateSample& sample : estimate.samples) {
    for (; next != options.flight.end() && next->frame < sample.frame; ++next) add_missing(*next);
    const bool in_flight = next != options.flight.end() && next->frame == sample.frame;
    flown.push_back({sample, in_flight ? next->t_ns : sample.t_ns, true});
    map_id = sample.map_id;
    if (in_flight) ++next;
  }
  for (; next != options.flight.end(); ++next) add_missing(*next);
  return flown;
}

void add_outcome(const std::vector<FlownFrame>& flown,
                 const std::vector<MatchedPose>& matches,
                 Score* score) {
  score->frames = static_cast<int>(flown.size());
  score->tracked_frames = static_cast<int>(std::count_if(flown.begin(), flown.end(), has_pose));
  score->outcome = Outcome::kNotInitialised;
  add_relocalisations(flown, score);
  if (score->tracked_frames == 0) return;

  score->coverage = static_cast<double>(score->tracked_frames) / score->frames;
  const auto first =
      static_cast<std::size_t>(std::find_if(flown.begin(), flown.end(), has_pose) - flown.begin());
  score->initialised_at_s = s_from_ns(flown[first].t_ns);
  std::set<int> maps;
  std::set<int> tracked_maps;
  for (std::size_t i = first; i < flown.size(); ++i) {
    maps.insert(flown[i].sample.map_id);
    if (has_pose(flown[i])) tracked_maps.insert(flown[i].sample.map_id);
  }
  score->reset_count = static_cast<int>(maps.size()) - 1;

  const std::vector<bool> held = held_frames(flown);
  const auto after_init = static_cast<double>(flown.size() - first);
  const auto kept = static_cast<double>(std::count(held.begin(), held.end(), true));
  if (const auto diverged_ns = divergence_time_ns(matches)) {
    score->outcome = Outcome::kDiverged;
    score->outcome_time_s = s_from_ns(flight_time_ns(flown, *diverged_ns));
  } else if (tracked_maps.size() > 1) {
    score->outcome = Outcome::kReset;
    score->outcome_time_s = reset_time_s(flown, first);
  } else if (!held.back() || kept < kCompletedShare * after_init) {
    score->outcome = Outcome::kLost;
    score->outcome_time_s = loss_time_s(flown, held, first);
  } else if (starts_late(flown, first)) {
    score->outcome = Outcome::kInitLate;
    score->outcome_time_s = score->initialised_at_s;
  } else {
    score->outcome = Outcome::kCompleted;
  }
}

const char* to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::kCompleted:
      return "COMPLETED";
    case Outcome::kNotInitialised:
      return "NOT_INITIALISED";
    case Outcome::kInitLate:
      return "INIT_LATE";
    case Outcome::kLost:
      return "LOST";
    case Outcome::kReset:
      return "RESET";
    case Outcome::kDiverged:
      return "DIVERGED";
    case Outcome::kCrashed:
      return "CRASHED";
    case Outcome::kTimeout:
      return "TIMEOUT";
  }
  return "";
}

std::optional<Outcome> outcome_from(const std::string& text) {
  for (const Outcome outcome : {Outcome::kCompleted,
                                Outcome::kNotInitialised,
                                Outcome::kInitLate,
                                Outcome::kLost,
                                Outcome::kReset,
                                Outcome::kDiverged,
                                Outcome::kCrashed,
                                Outcome::kTimeout}) {
    if (text == to_string(outcome)) return outcome;
  }
  return std::nullopt;
}

}  // namespace overfly::evaluation
