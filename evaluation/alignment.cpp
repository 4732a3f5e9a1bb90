#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/time.hpp"
#include "evaluation/evaluation.hpp"
#include "evaluation/umeyama.hpp"

namespace overfly::evaluation {
namespace {

constexpr std::int64_t kInitPathNs = 5 * kNsPerS;

/// As steps where times are not known: 5 s at the 10 Hz of the KITTI benchmark.
constexpr std::size_t kInitPathSteps = 50;

const char* init_path_words(const Options& options) {
  return options.has_times ? "the first 5 s" : "the first 50 steps (times are not known)";
}

/// Ratio of the path lengths of truth and estimate at the beginning.
Result<double> scale_from_path(const std::vector<MatchedPose>& matches, const Options& options) {
  double truth_m = 0.0;
  double vo = 0.0;
  for (std::size_t i = 1; i < matches.size(); ++i) {
    const bool beyond = options.has_times ? matches[i].t_ns - matches.front().t_ns > kInitPathNs
                                          : i > kInitPathSteps;
    if (beyond) break;
    truth_m +=
        (matches[i].T_world_camera.translation - matches[i - 1].T_world_camera.translation).norm();
    vo += (matches[i].T_vo_camera.translation - matches[i - 1].T_vo_camera.translation).norm();
  }
  if (truth_m > 0.0 && vo > 0.0 && std::isfinite(truth_m / vo)) return truth_m / vo;
  return Error{ErrorCode::kInvalidArgument,
               std::string("no scene depth at the first pose, and ") +
                   (vo > 0.0 ? "the truth" : "the estimate") + " does not move in " +
                   init_path_words(options) + ": the scale cannot be determined"};
}

Result<double> init_scale(const std::vector<MatchedPose>& matches,
                          const Options& options,
                          AlignmentRemarks* remarks) {
  const std::optional<double> depth = matches.front().scene_depth;
  const bool has_depth = depth && std::isfinite(*depth) && *depth > 0.0;
  if (has_depth && options.init_true_depth_m) return *options.init_true_depth_m / *depth;
  Result<double> scale = scale_from_path(matches, options);
  if (scale && remarks != nullptr) {
    remarks->notes.push_back(std::string("scale from the path of ") + init_path_words(options) +
                             ": " + (has_depth ? "the true depth" : "the estimate's scene depth") +
                             " at the first pose is unknown");
  }
  return scale;
}

/// Number of poses that first_sim3 is fitted to where times are not known: 10 s at the 10 Hz of the
/// KITTI benchmark.
constexpr std::size_t kFirstPoses = 100;

std::vector<MatchedPose> first_poses(const std::vector<MatchedPose>& matches,
                                     const Options& options) {
  auto end = matches.begin() + static_cast<std::ptrdiff_t>(std::min(kFirstPoses, matches.size()));
  if (options.has_times) {
    end = std::find_if(matches.begin(), matches.end(), [&](const MatchedPose& match) {
      return match.t_ns - matches.front().t_ns > ns_from_s(options.first_s);
    });
  }
  return {matches.begin(), end};
}

/// "the first 101 of 600 poses (10.0 s)"
std::string first_words(const std::vector<MatchedPose>& first,
                        const std::vector<MatchedPose>& matches,
                        const Options& options) {
  std::array<char, 100> text{};
  const std::string poses = std::to_string(first.size()) + " of " + std::to_string(matches.size());
  if (!options.has_times) return "the first " + poses + " poses (times are not known)";
  std::snprintf(text.data(),
                text.size(),
                "the first %s poses (%.1f s)",
                poses.c_str(),
                s_from_ns(first.back().t_ns - first.front().t_ns));
  return text.data();
}

Result<Similarity> fit_first(const std::vector<MatchedPose>& matches,
                             const Options& options,
                             AlignmentRemarks* remarks) {
  const std::vector<MatchedPose> first = first_poses(matches, options);
  const std::string words = first_words(first, matches, options);
  if (remarks != nullptr) remarks->notes.push_back("fitted to " + words);
  Result<Similarity> S_world_vo = fit_similarity(
      first, {.with_scale = true, .hold_first = false, .turn_nearly_straight = true}, remarks);
  if (!S_world_vo) return S_world_vo.error().in(words);
  return S_world_vo;
}

/// The similarity with a given scale that aligns the first poses.
Similarity first_pose(const MatchedPose& first, double scale) {
  Similarity S_world_vo;
  S_world_vo.scale = scale;
  S_world_vo.rotation =
      (first.T_world_camera.rotation * first.T_vo_camera.rotation.conjugate()).normalized();
  S_world_vo.translation = first.T_world_camera.translation -
                           scale * (S_world_vo.rotation * first.T_vo_camera.translation);
  return S_world_vo;
}

struct ModeName {
  AlignmentMode mode;
  const char* name;
};

constexpr std::array<ModeName, 8> kModeNames{{{AlignmentMode::kNone, "none"},
                                              {AlignmentMode::kOrigin, "origin"},
                                              {AlignmentMode::kInitScale, "init_scale"},
                                              {AlignmentMode::kSe3, "se3"},
                                              {AlignmentMode::kSim3, "sim3"},
                                              {AlignmentMode::kYawOnly, "yaw_only"},
                                              {AlignmentMode::kOriginSim3, "origin_sim3"},
                                              {AlignmentMode::kFirstSim3, "first_sim3"}}};

}  // namespace

const char* to_string(AlignmentMode mode) {
  for (const ModeName& entry : kModeNames) {
    if (entry.mode == mode) return entry.name;
  }
  return "";
}

std::optional<AlignmentMode> alignment_mode_from(const std::string& text) {
  for (const ModeName& entry : kModeNames) {
    if (text == entry.name) return entry.mode;
  }
  return std::nullopt;
}

const std::vector<AlignmentMode>& all_alignment_modes() {
  static const std::vector<AlignmentMode> modes = [] {
    std::vector<AlignmentMode> all(kModeNames.size());
    std::transform(kModeNames.begin(), kModeNames.end(), all.begin(), [](const ModeName& entry) {
      return entry.mode;
    });
    return all;
  }();
  return modes;
}

Result<Similarity> align(const std::vector<MatchedPose>& matches,
                         AlignmentMode mode,
                         const Options& options,
                         AlignmentRemarks* remarks) {
  if (matches.empty())
    return Error{ErrorCode::kInvalidArgument, "0 matched poses: nothing to align"};
  switch (mode) {
    case AlignmentMode::kNone:
      return Similarity{};
    case AlignmentMode::kOrigin:
      return first_pose(matches.front(), 1.0);
    case AlignmentMode::kInitScale: {
      const Result<double> scale = init_scale(matches, options, remarks);
      if (!scale) return scale.error();
      return first_pose(matches.front(), *scale);
    }
    case AlignmentMode::kSe3:
      return fit_similarity(matches, {.with_scale = false, .hold_first = false}, remarks);
    case AlignmentMode::kSim3:
      return fit_similarity(matches, {.with_scale = true, .hold_first = false}, remarks);
    case AlignmentMode::kYawOnly:
      return fit_yaw(matches);
    case AlignmentMode::kOriginSim3:
      return fit_similarity(matches, {.with_scale = true, .hold_first = true}, remarks);
    case AlignmentMode::kFirstSim3:
      return fit_first(matches, options, remarks);
  }
  return Error{ErrorCode::kInvalidArgument, "unknown alignment mode"};
}

}  // namespace overfly::evaluation
