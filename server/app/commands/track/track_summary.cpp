#include "server/app/commands/track/track_summary.hpp"

#include <array>
#include <cstdio>

#include "server/app/score_table.hpp"
#include "server/dataset/track_report.hpp"

namespace overfly::app {
namespace {

std::string rounded(double value, int digits) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string duration_text(const server::DurationList& durations) {
  const auto summary = durations.latencies();
  if (!summary) return "-";
  return rounded(summary->median_ms, 1) + " ms median, " + rounded(summary->p95_ms, 1) +
         " ms p95, " + rounded(summary->max_ms, 1) + " ms at most";
}

std::string dataset_text(const server::Dataset& dataset) {
  const PinholeCamera& camera = dataset.camera.pinhole();
  std::string text = "data set: " + std::string(server::to_string(dataset.layout)) + ", " +
                     std::to_string(dataset.images.size()) + " images of " +
                     std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px) +
                     " px\n";
  for (const std::string& note : dataset.notes) text += "note: " + note + "\n";
  return text;
}

/// A line if some frames are affected.
std::string count_text(const std::string& name, std::int64_t frames) {
  return frames > 0 ? name + ": " + std::to_string(frames) + " frames\n" : "";
}

std::string states_text(const server::Dataset& dataset,
                        const server::TrackedDataset& tracked,
                        const server::TrackFigures& figures) {
  std::string text = "estimator: " + tracked.type + "; TRACKING " +
                     std::to_string(figures.tracked_frames) + ", INITIALISING " +
                     std::to_string(figures.initialising_frames) + ", LOST " +
                     std::to_string(figures.lost_frames) + " of " +
                     std::to_string(tracked.records.size()) + " frames";
  if (dataset.images.size() > tracked.records.size()) {
    text += ", " + std::to_string(dataset.images.size() - tracked.records.size()) + " not sent";
  }
  if (figures.initialised_after_s) {
    text += ", first pose after " + rounded(*figures.initialised_after_s, 2) + " s";
  }
  text += "\n";
  if (figures.maps > 1) {
    text += "resets: " + std::to_string(figures.maps) + " maps, the longest is written\n";
  }
  text += count_text("unanswered", tracked.unanswered);
  text += count_text("hash_mismatches", tracked.hash_mismatches);
  if (figures.crash) text += (figures.hung ? "TIMEOUT: " : "CRASHED: ") + *figures.crash + "\n";
  return text;
}

std::string cost_text(const server::TrackedDataset& tracked, const server::TrackFigures& figures) {
  std::string text = "track: " + duration_text(tracked.tracking) + "\n";
  for (const auto& [stage, durations] : tracked.stages) {
    text += "  " + stage + ": " + duration_text(durations) + "\n";
  }
  return text + "memory: " + rounded(tracked.resources.peak_memory_mb, 0) + " MB at most, CPU " +
         rounded(figures.cpu_percent, 0) + " % while tracking, of " + figures.measured_process +
         "\n";
}

std::string score_text(const evaluation::Score& score) {
  // Without the time of the outcome: it is in the data set's time base, often seconds since 1970.
  const int relocalisations = score.relocalisations.value_or(0);
  return "outcome: " + std::string(evaluation::to_string(score.outcome)) +
         (relocalisations > 0 ? ", relocalisations: " + std::to_string(relocalisations) : "") +
         ", " + coverage_text(score) + "\n" + alignment_table(score);
}

}  // namespace

std::string track_summary(const server::Dataset& dataset,
                          const server::TrackedDataset& tracked,
                          const std::optional<evaluation::Score>& score,
                          const std::string& out) {
  const server::TrackFigures figures = server::figures_of(tracked);
  return dataset_text(dataset) + states_text(dataset, tracked, figures) +
         cost_text(tracked, figures) + (score ? score_text(*score) : "") + "trajectory: " + out +
         "\n";
}

}  // namespace overfly::app
