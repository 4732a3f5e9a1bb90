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
constexpr double kWindowMinM = 1.0;  // a window with less true way has no scale

bool tracked(const EstimateSample& sample) { return sample.state == TrackingState::kTracking; }

/// Way of truth and estimate over one second; `broken` where poses are missing in between.
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

/// Begin of the last loss if the track ends without tracking, else of the first loss.
std::optional<double> loss_time_s(const std::vector<EstimateSample>& samples, std::size_t first) {
  std::optional<double> begin_s;
  bool lost = false;
  for (std::size_t i = first; i < samples.size(); ++i) {
    if (!tracked(samples[i]) && !lost && (!begin_s || !tracked(samples.back()))) {
      begin_s = s_from_ns(samples[i].t_ns);
    }
    lost = !tracked(samples[i]);
  }
  return begin_s;
}

/// Time of the first sample of a later map than the first tracked one's.
std::optional<double> reset_time_s(const std::vector<EstimateSample>& samples, std::size_t first) {
  for (std::size_t i = first; i < samples.size(); ++i) {
    if (samples[i].map_id != samples[first].map_id) return s_from_ns(samples[i].t_ns);
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> divergence_time_s(const std::vector<MatchedPose>& matches) {
  const std::vector<Step> steps = steps_of(matches);
  double smallest = INFINITY;
  double largest = 0.0;
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
    const double scale = vo / truth_m;  // this way round: an estimate that stands still has 0
    smallest = std::min(smallest, scale);
    largest = std::max(largest, scale);
    if (largest > kScaleChange * smallest) return s_from_ns(steps[end - 1].end_ns);
  }
  return std::nullopt;
}

void add_outcome(const EstimateTrack& estimate,
                 const std::vector<MatchedPose>& matches,
                 Score* score) {
  const std::vector<EstimateSample>& samples = estimate.samples;
  score->frames = static_cast<int>(samples.size());
  score->tracked_frames = static_cast<int>(std::count_if(samples.begin(), samples.end(), tracked));
  score->outcome = Outcome::kNotInitialised;
  if (score->tracked_frames == 0) return;

  score->coverage = static_cast<double>(score->tracked_frames) / score->frames;
  const auto first = static_cast<std::size_t>(
      std::find_if(samples.begin(), samples.end(), tracked) - samples.begin());
  score->initialised_at_s = s_from_ns(samples[first].t_ns);
  std::set<int> tracked_maps;
  int last_map = samples[first].map_id;
  for (std::size_t i = first; i < samples.size(); ++i) {
    if (tracked(samples[i])) tracked_maps.insert(samples[i].map_id);
    last_map = std::max(last_map, samples[i].map_id);
  }
  score->reset_count = last_map - samples[first].map_id;

  const double after_init = static_cast<double>(samples.size() - first);
  const bool completed =
      tracked(samples.back()) && score->tracked_frames >= kCompletedShare * after_init;
  if (const auto diverged_s = divergence_time_s(matches)) {
    score->outcome = Outcome::kDiverged;
    score->outcome_time_s = diverged_s;
  } else if (tracked_maps.size() > 1) {
    score->outcome = Outcome::kReset;
    score->outcome_time_s = reset_time_s(samples, first);
  } else if (!completed) {
    score->outcome = Outcome::kLost;
    score->outcome_time_s = loss_time_s(samples, first);
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

}  // namespace overfly::evaluation
