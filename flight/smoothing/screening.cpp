#include "flight/smoothing/screening.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/motion/pose.hpp"

namespace overfly::flight::smoothing {
namespace {

/// A prediction over a longer time says nothing.
constexpr double kLongestExcursionS = 1.0;
constexpr std::size_t kReturnSamples = 3;
constexpr double kShortestPieceS = 1.0;
constexpr std::size_t kFewestSamples = 5;
/// A filter has settled after this.
constexpr double kSettlingS = 5.0;
/// Samples with more steps are not those of a flight.
constexpr std::size_t kMaxSteps = 1000;
constexpr std::size_t kSettlingSamples = 500;

/// Samples without a step between them.
struct Piece {
  std::vector<std::size_t> samples;
};

struct MeasuredStep {
  std::size_t sample = 0;
  TrackStep step;
};

template <typename Sample>
bool is_long_enough(std::span<const Sample> samples, const Piece& piece) {
  return piece.samples.size() >= kFewestSamples &&
         samples[piece.samples.back()].t_s - samples[piece.samples.front()].t_s >= kShortestPieceS;
}

/// Whether a flight returns to a filter at sample i: a single wrong sample may fit by chance, three
/// in a row do not.
template <typename Track>
bool returns(std::span<const typename Track::Sample> samples, std::size_t i, Track track) {
  if (samples[i].t_s - track.time_s() > kLongestExcursionS) return false;
  const std::size_t end = std::min(i + kReturnSamples, samples.size());
  for (; i < end; ++i) {
    if (!track.fits(samples[i], Gate::kReturn)) return false;
    track.take(samples[i]);
  }
  return true;
}

/// Divides samples at steps. A filter follows the flight. From the first sample that it refuses, a
/// second filter follows the samples as if they had stepped; the flight returns if a sample fits
/// the first filter and not the second, and has stepped when the second has lasted.
template <typename Track>
std::vector<Piece> pieces_of(std::span<const typename Track::Sample> samples,
                             const TrackLimits& limits) {
  std::vector<Piece> pieces{Piece{{0}}};
  Track track(limits);
  track.start(samples[0]);
  Track other(limits);
  Piece stepped;  // what the second filter followed; empty: there is none
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (stepped.samples.empty() && track.fits(samples[i], Gate::kNext)) {
      track.take(samples[i]);
      pieces.back().samples.push_back(i);
    } else if (!stepped.samples.empty() && other.fits(samples[i], Gate::kNext)) {
      other.take(samples[i]);
      stepped.samples.push_back(i);
      if (!is_long_enough(samples, stepped)) continue;
      track = other;
      pieces.push_back(std::exchange(stepped, {}));
    } else if (!stepped.samples.empty() && returns<Track>(samples, i, track)) {
      track.take(samples[i]);
      pieces.back().samples.push_back(i);
      stepped.samples.clear();
    } else {
      other = track;
      other.restart(samples[i]);
      stepped.samples.assign(1, i);
    }
  }
  return pieces;
}

/// A filter that has run over the end of a piece, forward, or over its start, backward.
template <typename Track>
Track track_over(std::span<const typename Track::Sample> samples,
                 const Piece& piece,
                 bool forward,
                 const TrackLimits& limits) {
  const std::vector<std::size_t>& all = piece.samples;
  const double end_s = samples[forward ? all.back() : all.front()].t_s;
  std::size_t count = 0;
  const auto nth = [&](std::size_t k) { return forward ? all[all.size() - 1 - k] : all[k]; };
  while (count < all.size() && count < kSettlingSamples &&
         std::abs(samples[nth(count)].t_s - end_s) <= kSettlingS) {
    ++count;
  }
  Track track(limits);
  track.start(samples[nth(count - 1)]);
  for (std::size_t k = count - 1; k-- > 0;) track.take(samples[nth(k)]);
  return track;
}

/// The levels on which the flight's pieces lie, and the level of each piece.
struct Levels {
  std::vector<Eigen::Vector3d> offset;
  std::vector<std::size_t> of_piece;
};

/// @param yaw  the z parts are angles
Levels levels_of(const std::vector<MeasuredStep>& steps, double tolerance, bool yaw) {
  const auto wrapped = [&](Eigen::Vector3d v) {
    if (yaw) v.z() = wrap_pi(v.z());
    return v;
  };
  Levels levels{{Eigen::Vector3d::Zero()}, {0}};
  for (const MeasuredStep& measured : steps) {
    const TrackStep& step = measured.step;
    const Eigen::Vector3d arrived = wrapped(levels.offset[levels.of_piece.back()] + step.size);
    // Two steps lead there and back, each with its error.
    const double near = std::max(tolerance, kGateSigmas * std::sqrt(2.0) * step.sigma);
    std::size_t level = 0;
    while (level < levels.offset.size() && wrapped(arrived - levels.offset[level]).norm() > near) {
      ++level;
    }
    if (level == levels.of_piece.back()) level = levels.offset.size();
    if (level == levels.offset.size()) levels.offset.push_back(arrived);
    levels.of_piece.push_back(level);
  }
  return levels;
}

/// Each level by all steps between it and an earlier level: there and back.
void average_levels(const std::vector<MeasuredStep>& steps, bool yaw, Levels& levels) {
  for (std::size_t level = 1; level < levels.offset.size(); ++level) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0.0;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const std::size_t from = levels.of_piece[k];
      const std::size_t to = levels.of_piece[k + 1];
      Eigen::Vector3d seen;
      if (to == level && from < level) {
        seen = levels.offset[from] + steps[k].step.size;
      } else if (from == level && to < level) {
        seen = levels.offset[to] - steps[k].step.size;
      } else {
        continue;
      }
      Eigen::Vector3d change = seen - levels.offset[level];
      if (yaw) change.z() = wrap_pi(change.z());
      sum += change;
      count += 1.0;
    }
    levels.offset[level] += sum / std::max(1.0, count);
  }
}

template <typename Track>
std::optional<Screening> screen(std::span<const typename Track::Sample> samples,
                                const TrackLimits& limits,
                                double tolerance,
                                bool yaw) {
  std::vector<Piece> found = pieces_of<Track>(samples, limits);
  std::erase_if(found, [&](const Piece& piece) { return !is_long_enough(samples, piece); });
  if (found.empty() || found.size() > kMaxSteps) return std::nullopt;

  std::vector<Piece> pieces{std::move(found.front())};
  std::vector<MeasuredStep> steps;
  for (std::size_t k = 1; k < found.size(); ++k) {
    const TrackStep step = Track::step(track_over<Track>(samples, pieces.back(), true, limits),
                                       track_over<Track>(samples, found[k], false, limits));
    if (step.continues) {
      pieces.back().samples.insert(
          pieces.back().samples.end(), found[k].samples.begin(), found[k].samples.end());
      continue;
    }
    steps.push_back({found[k].samples.front(), step});
    pieces.push_back(std::move(found[k]));
  }
  Levels levels = levels_of(steps, tolerance, yaw);
  average_levels(steps, yaw, levels);
  std::vector<std::size_t> counts(levels.offset.size(), 0);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    counts[levels.of_piece[k]] += pieces[k].samples.size();
  }
  const auto main =
      static_cast<std::size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());

  Screening result;
  result.kept.assign(samples.size(), false);
  result.shift.assign(samples.size(), Eigen::Vector3d::Zero());
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const Eigen::Vector3d shift = levels.offset[levels.of_piece[k]] - levels.offset[main];
    for (const std::size_t i : pieces[k].samples) {
      result.kept[i] = true;
      result.shift[i] = shift;
    }
  }
  for (const MeasuredStep& step : steps) result.steps.push_back({step.sample, step.step.size});
  return result;
}

}  // namespace

std::optional<Screening> screen_positions(std::span<const PositionSample> samples,
                                          const TrackLimits& limits) {
  return screen<PositionTrack>(samples, limits, limits.position_jump_m, false);
}

std::optional<Screening> screen_attitudes(std::span<const AttitudeSample> samples,
                                          const TrackLimits& limits) {
  return screen<AttitudeTrack>(samples, limits, limits.attitude_jump_rad, true);
}

}  // namespace overfly::flight::smoothing
