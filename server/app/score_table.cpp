#include "server/app/score_table.hpp"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>

#include "server/scoring/camera_metrics.hpp"

namespace overfly::app {
namespace {

[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...) {
  std::array<char, 400> line{};
  va_list arguments;
  va_start(arguments, format);
  // The analyzer does not see that va_start has set it.
  // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start is above
  std::vsnprintf(line.data(), line.size(), format, arguments);
  va_end(arguments);
  return line.data();
}

/// A number in a column; a dash if there is none.
std::string figure(const std::optional<double>& value, int width, int digits) {
  return value ? formatted("%*.*f", width, digits, *value) : formatted("%*s", width, "-");
}

std::optional<double> rmse_of(const std::optional<evaluation::ErrorStatistics>& errors) {
  return errors ? std::optional<double>(errors->rmse) : std::nullopt;
}

/// The reason why an alignment has no rotation errors; empty if it has them.
std::string degenerate_text(const evaluation::AlignmentScore& alignment) {
  if (!alignment.degenerate) return "";
  return "    degenerate: " + *alignment.degenerate + "; no rotation error\n";
}

/// "    position NEES 3.1, expected in [2.9, 3.1]: overconfident, ..." of one part of the pose.
std::string nees_text(const char* part, const std::optional<evaluation::Nees>& nees) {
  if (!nees) return "";
  const bool consistent = nees->honesty == evaluation::Honesty::kConsistent;
  std::string text =
      formatted("    %s NEES %.3g (expected %d; 95 %% band %.3g to %.3g, %d poses): ",
                part,
                nees->mean,
                nees->degrees,
                nees->band_95.low,
                nees->band_95.high,
                nees->samples);
  text += evaluation::to_string(nees->honesty);
  if (!consistent) {
    text += formatted(", errors are %.3g times the stated deviations", nees->deviation_ratio());
  }
  return text + "\n";
}

std::string consistency_text(const evaluation::AlignmentScore& alignment) {
  const auto& consistency = alignment.consistency;
  if (!consistency) return "";
  std::string text = nees_text("position", consistency->position) +
                     nees_text("rotation", consistency->rotation) +
                     nees_text("pose", consistency->pose);
  if (consistency->singular > 0) {
    text += formatted("    %d poses have a singular covariance: they have no NEES\n",
                      consistency->singular);
  }
  return text;
}

std::string notes_text(const evaluation::AlignmentScore& alignment) {
  std::string text;
  for (const std::string& note : alignment.notes) text += "    " + note + "\n";
  return text;
}

std::string left_out_text(const evaluation::Score& score) {
  if (score.covariances.left_out == 0) return "";
  return formatted("  %d of %d stated covariances are invalid and left out\n",
                   score.covariances.left_out,
                   score.covariances.left_out + score.covariances.stated);
}

/// Why an estimator ended, and frames without a usable answer.
std::string trouble_text(const server::EstimatorMetrics& estimator) {
  std::string text;
  // Estimators that never ran are reported as errors.
  if (estimator.crash && estimator.answered > 0) {
    const bool hung = estimator.score.outcome == evaluation::Outcome::kTimeout;
    text += (hung ? "    timed out: " : "    crashed: ") + *estimator.crash + "\n";
  }
  const auto count = [&](const char* name, std::int64_t frames) {
    if (frames > 0)
      text += formatted("    %s: %lld frames\n", name, static_cast<long long>(frames));
  };
  count("unanswered", estimator.unanswered);
  count("hash_mismatches", estimator.hash_mismatches);
  return text;
}

/// One line for each interval that the path has, and on request one for the others.
std::string fix_drift_text(const evaluation::AlignmentScore& alignment, bool with_missing) {
  std::string text;
  std::string missing;
  std::string reason;
  for (const evaluation::FixDrift& drift : alignment.fix_drift) {
    const std::string interval = formatted("%g", 1e-3 * drift.interval_m);
    if (!drift.unavailable.empty()) {
      missing += (missing.empty() ? "" : ", ") + interval;
      reason = drift.unavailable;
      continue;
    }
    text += formatted(
        "    with a position fix every %s km: off by %.3f m (median), %.3f m (worst of %d)\n",
        interval.c_str(),
        drift.median_m,
        drift.worst_m,
        drift.segments);
  }
  if (missing.empty() || !with_missing) return text;
  return text + "    with a position fix every " + missing + " km: not known, " + reason + "\n";
}

std::string outcome_text(const evaluation::Score& score) {
  std::string text = evaluation::to_string(score.outcome);
  if (score.outcome_time_s) text += formatted(" at %.1f s", *score.outcome_time_s);
  if (score.outcome_distance_m) text += formatted(", after %.0f m", *score.outcome_distance_m);
  return text;
}

/// "found its map again 2 times, first at 15.1 s"; empty if it never did.
std::string relocalised_text(const evaluation::Score& score) {
  const int times = score.relocalisations.value_or(0);
  if (times == 0 || !score.relocalised_at_s) return "";
  const std::string count = times == 1 ? "" : formatted(" %d times, first", times);
  return "found its map again" + count + formatted(" at %.1f s", *score.relocalised_at_s);
}

/// @param name  of the camera, for people
std::string notes_of(const std::string& name, const server::CameraMetrics& camera) {
  std::string notes;
  if (camera.texture.limited) {
    notes += formatted(
        "warning: texture_limited: %s sees %.2f texels per pixel (median), below 0.5: the imagery, "
        "not the camera, limits the result\n",
        name.c_str(),
        camera.texture.texels_per_pixel_median);
  }
  const std::string without_imagery = server::void_words(name, camera);
  if (!without_imagery.empty()) notes += "warning: no imagery: " + without_imagery + "\n";
  if (camera.late_tiles > 0) {
    notes += formatted(
        "warning: %s: %lld tiles were late and drawn at a coarser level, in %lld frames\n",
        name.c_str(),
        static_cast<long long>(camera.late_tiles),
        static_cast<long long>(camera.frames_with_late_tiles));
  }
  for (const auto& [kind, frames] : camera.faults) {
    notes += formatted("fault: %s of %s, %lld frames\n",
                       kind.c_str(),
                       name.c_str(),
                       static_cast<long long>(frames));
  }
  return notes;
}

/// The values by the names of their modes, in alphabetical order.
template <typename Value>
std::map<std::string, const Value*> by_name(
    const std::map<evaluation::AlignmentMode, Value>& values) {
  std::map<std::string, const Value*> named;
  for (const auto& [mode, value] : values) named[evaluation::to_string(mode)] = &value;
  return named;
}

/// The errors of one alignment in a line of the score table, or why there are none.
std::string errors_text(const evaluation::Score& score, evaluation::AlignmentMode mode) {
  const auto found = score.alignments.find(mode);
  if (found == score.alignments.end()) {
    const auto reason = score.unavailable.find(mode);
    return "  X (" + (reason == score.unavailable.end() ? "not scored" : reason->second) + ")\n";
  }
  const evaluation::AlignmentScore& alignment = found->second;
  return formatted("  %12.3f %12.3f ", alignment.position_m.rmse, alignment.position_rmse_hold_m) +
         figure(rmse_of(alignment.rotation_deg), 12, 4) + "\n" + degenerate_text(alignment) +
         consistency_text(alignment) + fix_drift_text(alignment, false) + notes_text(alignment);
}

}  // namespace

std::string camera_notes(const server::RunMetrics& metrics) {
  std::string notes;
  for (std::size_t i = 0; i < metrics.cameras.size(); ++i) {
    const server::CameraMetrics& camera = metrics.cameras[i];
    notes += notes_of(i == server::kMainCamera ? "the camera" : "camera " + camera.name, camera);
  }
  return notes;
}

std::string score_table(const server::RunMetrics& metrics, evaluation::AlignmentMode mode) {
  if (metrics.estimators.empty()) return "no estimators\n";
  std::string table = formatted("%-16s %-34s %9s %8s  %12s %12s %12s\n",
                                "estimator",
                                "outcome",
                                "coverage",
                                "dropped",
                                "position [m]",
                                "held [m]",
                                "rot. [deg]");
  for (const auto& [name, estimator] : metrics.estimators) {
    table += formatted("%-16s %-34s %7.1f %% %8lld",
                       name.c_str(),
                       outcome_text(estimator.score).c_str(),
                       100.0 * estimator.score.coverage,
                       static_cast<long long>(estimator.dropped_frames)) +
             errors_text(estimator.score, mode);
    const std::string relocalised = relocalised_text(estimator.score);
    if (!relocalised.empty()) table += "    " + relocalised + "\n";
    table += trouble_text(estimator) + left_out_text(estimator.score);
  }
  return table + "RMSE, alignment " + evaluation::to_string(mode) + "\n";
}

std::string coverage_text(const evaluation::Score& score) {
  return formatted("coverage %.1f %%", 100.0 * score.coverage);
}

std::string outcome_line(const evaluation::Score& score) {
  const std::string relocalised = relocalised_text(score);
  return outcome_text(score) + (relocalised.empty() ? "" : "; " + relocalised) + ", " +
         coverage_text(score);
}

std::string alignment_table(const evaluation::Score& score) {
  std::string table = formatted("  %-12s %12s %8s  %12s %12s %12s %14s %6s\n",
                                "alignment",
                                "scale",
                                "poses",
                                "position [m]",
                                "held [m]",
                                "rot. [deg]",
                                "euler n. [deg]",
                                "AUC");
  for (const auto& [mode, alignment] : by_name(score.alignments)) {
    table += formatted("  %-12s %12.6g %8d  %12.3f %12.3f ",
                       mode.c_str(),
                       alignment->S_world_vo.scale,
                       alignment->matched,
                       alignment->position_m.rmse,
                       alignment->position_rmse_hold_m) +
             figure(rmse_of(alignment->rotation_deg), 12, 4) + " " +
             figure(rmse_of(alignment->rotation_euler_norm_deg), 14, 4) + " " +
             figure(alignment->position_auc, 6, 3) + "\n" + degenerate_text(*alignment) +
             consistency_text(*alignment) + fix_drift_text(*alignment, true) +
             notes_text(*alignment);
  }
  if (score.position_auc_limit_m) {
    table += formatted(
        "  AUC: area under the share of the flight's frames with an error below 0 to %g m, 1 is "
        "best\n",
        *score.position_auc_limit_m);
  }
  table += left_out_text(score);
  for (const auto& [mode, reason] : by_name(score.unavailable)) {
    table += formatted("  %-12s X: ", mode.c_str()) + *reason + "\n";
  }
  return table;
}

std::vector<std::string> alignment_mode_names() {
  std::vector<std::string> names;
  for (const evaluation::AlignmentMode mode : evaluation::all_alignment_modes()) {
    names.emplace_back(evaluation::to_string(mode));
  }
  return names;
}

}  // namespace overfly::app
