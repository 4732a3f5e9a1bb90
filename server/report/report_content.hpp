// What a report is about.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "evaluation/evaluation.hpp"
#include "server/report/run/report_run.hpp"

namespace overfly::server::report {

/// A run that could not be reported.
struct LeftOutRun {
  std::string name;
  std::string reason;
};

struct ReportContent {
  std::vector<ReportRun> runs;
  std::vector<LeftOutRun> left_out;
  /// Of the errors and poses over time.
  evaluation::AlignmentMode alignment = evaluation::AlignmentMode::kInitScale;
  /// Indices of runs with the same flight.
  std::vector<std::vector<std::size_t>> groups;
};

/// One estimator of one run.
struct ReportEntry {
  const ReportRun* run = nullptr;
  const ReportEstimate* estimate = nullptr;

  [[nodiscard]] const EstimatorMetrics& metrics() const { return run->metrics_of(*estimate); }
  /// By an alignment; null if it cannot be determined.
  [[nodiscard]] const evaluation::AlignmentScore* aligned(evaluation::AlignmentMode mode) const {
    const auto found = metrics().score.alignments.find(mode);
    return found == metrics().score.alignments.end() ? nullptr : &found->second;
  }
};

/// The estimators of the runs with these indices, run by run.
[[nodiscard]] inline std::vector<ReportEntry> entries_of(const ReportContent& content,
                                                         const std::vector<std::size_t>& runs) {
  std::vector<ReportEntry> entries;
  for (const std::size_t index : runs) {
    const ReportRun& run = content.runs.at(index);
    for (const ReportEstimate& estimate : run.estimates) entries.push_back({&run, &estimate});
  }
  return entries;
}

}  // namespace overfly::server::report
