#include "server/report/run/run_warnings.hpp"

#include <algorithm>
#include <cmath>

#include "core/text/number_text.hpp"
#include "core/text/percent.hpp"
#include "core/time.hpp"
#include "server/report/run/words.hpp"
#include "server/scoring/camera_metrics.hpp"

namespace overfly::server::report {
namespace {

std::string camera_words(const ReportRun& run, std::size_t camera) {
  const std::string& name = run.cameras.at(camera).name;
  return run.cameras.size() == 1 || name.empty() ? "the camera" : "camera " + name;
}

bool agrees(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)});
}

/// Whether the file has the outcomes and errors that follow from the rows. Alignments that it lacks
/// are no difference: earlier versions wrote fewer.
bool same_scores(const RunMetrics& recorded, const RunMetrics& scored) {
  if (recorded.estimators.size() != scored.estimators.size()) return false;
  for (const auto& [name, estimator] : recorded.estimators) {
    const auto found = scored.estimators.find(name);
    if (found == scored.estimators.end()) return false;
    const evaluation::Score& now = found->second.score;
    if (estimator.score.outcome != now.outcome) return false;
    if (!agrees(estimator.score.coverage, now.coverage)) return false;
    for (const auto& [mode, alignment] : estimator.score.alignments) {
      const auto aligned = now.alignments.find(mode);
      if (aligned == now.alignments.end()) return false;
      if (!agrees(alignment.position_m.rmse, aligned->second.position_m.rmse)) return false;
    }
  }
  return true;
}

}  // namespace

RunWarnings::RunWarnings(const ReportRun& run,
                         const RunMetrics* recorded,
                         const std::vector<LogRow>& logs) {
  add_of_manifest(run);
  add_of_cameras(run);
  add_of_estimators(run);
  add_of_metrics(run, recorded);
  for (const LogRow& row : logs) {
    if (row.level != "warning" && row.level != "error") continue;
    add({row.level, row.source, row.text, s_from_ns(row.t_ns), 1});
  }
}

void RunWarnings::add(const ReportWarning& warning) {
  const auto known = std::find_if(list_.begin(), list_.end(), [&](const ReportWarning& other) {
    return other.text == warning.text && other.source == warning.source;
  });
  if (known != list_.end()) {
    // The log repeats what the manifest says: it is one warning, with its time.
    known->lines += known->first_s ? 1 : 0;
    if (!known->first_s) known->first_s = warning.first_s;
  } else if (list_.size() < kMost) {
    list_.push_back(warning);
  } else {
    ++left_out_;
  }
}

void RunWarnings::add_of_manifest(const ReportRun& run) {
  if (run.info.status != RunStatus::kCompleted) {
    const bool failed = run.info.status == RunStatus::kFailed;
    const std::string why = run.info.error.empty() ? "" : ": " + run.info.error;
    add({failed ? "error" : "warning",
         "",
         std::string("the run is ") + to_string(run.info.status) + why +
             "; what it recorded until then is scored",
         std::nullopt,
         1});
  }
  if (!run.info.problem.empty()) warn(run.info.problem);
  if (run.manifest.world) {
    for (const std::string& text : run.manifest.world->warnings) warn(text);
  }
  if (run.manifest.flight) {
    for (const std::string& text : run.manifest.flight->warnings) warn(text);
  }
  for (const RunManifest::Camera& camera : run.manifest.cameras) {
    if (!camera.calibrated) continue;
    note("",
         "camera " + camera.name +
             ": the estimators were given calibrated intrinsics, not the true ones");
  }
}

void RunWarnings::add_of_cameras(const ReportRun& run) {
  for (std::size_t i = 0; i < run.cameras.size() && i < run.metrics.cameras.size(); ++i) {
    const CameraMetrics& camera = run.metrics.cameras[i];
    const std::string name = camera_words(run, i);
    if (camera.texture.limited) {
      warn("texture_limited: " + name + " sees " +
           figure_text(camera.texture.texels_per_pixel_median) +
           " texels per pixel (median), below 0.5: the imagery, not the camera, limits the result");
    }
    const std::string without_imagery = void_words(name, camera);
    if (!without_imagery.empty()) warn("no imagery: " + without_imagery);
    const auto& frames = run.frames[i];
    const auto overexposed = std::count_if(frames.begin(), frames.end(), [](const FrameRow& row) {
      return row.saturated_fraction > kMostSaturated;
    });
    if (overexposed > 0) {
      warn("saturation: " + std::to_string(overexposed) + " of " + counted(frames.size(), "image") +
           " of " + name + " are overexposed (more than " + percent_text(kMostSaturated) +
           " of the pixels saturated)");
    }
    if (camera.late_tiles > 0) {
      warn(name + ": " + std::to_string(camera.late_tiles) +
           " tiles were late and drawn at a coarser level, in " +
           std::to_string(camera.frames_with_late_tiles) + " frames");
    }
    for (const auto& [kind, count] : camera.faults) {
      note("",
           "fault of the scenario: " + kind + " of " + name + ", " + std::to_string(count) +
               " frames");
    }
  }
  if (run.metrics.late_frames > 0) {
    warn(std::to_string(run.metrics.late_frames) +
         " frames were not rendered because their time had passed");
  }
}

void RunWarnings::add_of_estimators(const ReportRun& run) {
  for (const ReportEstimate& estimate : run.estimates) {
    const EstimatorMetrics& metrics = run.metrics_of(estimate);
    const auto about = [&](const std::string& text) {
      add({"warning", estimate.name, text, std::nullopt, 1});
    };
    if (metrics.test_estimator) note(estimate.name, "a test estimator: it is given the truth");
    if (metrics.hash_mismatches > 0) {
      about(std::to_string(metrics.hash_mismatches) + " of " +
            std::to_string(metrics.hashes_compared) +
            " images arrived at the estimator with other pixels than were sent");
    }
    if (metrics.score.covariances.left_out > 0) {
      about(std::to_string(metrics.score.covariances.left_out) +
            " stated covariances are invalid and left out");
    }
    if (metrics.unanswered > 0) {
      about(std::to_string(metrics.unanswered) + " frames were not answered in time");
    }
    if (metrics.crash) add({"error", estimate.name, *metrics.crash, std::nullopt, 1});
  }
}

void RunWarnings::add_of_metrics(const ReportRun& run, const RunMetrics* recorded) {
  if (recorded == nullptr) {
    warn("the folder has no readable metrics.json; this report has scored the rows itself");
  } else if (!same_scores(*recorded, run.metrics)) {
    warn(
        "metrics.json has other scores than follow from the rows; this report shows those of the "
        "rows (overfly evaluate --run writes them)");
  }
}

}  // namespace overfly::server::report
