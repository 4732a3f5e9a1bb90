// What a reader of a run's scores must know: warnings of its files, its images and its log.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "server/report/run/report_run.hpp"

namespace overfly::server::report {

class RunWarnings {
 public:
  /// Different warnings that are kept.
  static constexpr std::size_t kMost = 60;
  /// Images with a larger share of saturated pixels are overexposed, as in the run's log.
  static constexpr double kMostSaturated = 0.2;

  /// @param recorded  the metrics in the run's folder; null if it has none
  /// @param logs  of the run; its lines of the levels warning and error are warnings
  RunWarnings(const ReportRun& run, const RunMetrics* recorded, const std::vector<LogRow>& logs);

  /// Counts a warning that is there already.
  void add(const ReportWarning& warning);
  [[nodiscard]] std::vector<ReportWarning> list() && { return std::move(list_); }
  /// Different warnings beyond kMost.
  [[nodiscard]] std::size_t left_out() const { return left_out_; }

 private:
  void warn(const std::string& text) { add({"warning", "", text, std::nullopt, 1}); }
  void note(const std::string& source, const std::string& text) {
    add({"note", source, text, std::nullopt, 1});
  }
  void add_of_manifest(const ReportRun& run);
  void add_of_cameras(const ReportRun& run);
  void add_of_estimators(const ReportRun& run);
  void add_of_metrics(const ReportRun& run, const RunMetrics* recorded);

  std::vector<ReportWarning> list_;
  std::size_t left_out_ = 0;
};

}  // namespace overfly::server::report
