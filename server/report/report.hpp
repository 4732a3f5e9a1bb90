// A report of one or several runs: one HTML file that needs no other, no network and no script.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "evaluation/evaluation.hpp"
#include "server/report/figures/map_picture.hpp"
#include "server/report/report_content.hpp"

namespace overfly::server::report {

inline constexpr std::size_t kMaxRuns = 32;
inline constexpr std::uint64_t kMaxReportBytes = std::uint64_t{64} << 20U;
/// Frames and answers of all runs, which are in memory together.
inline constexpr std::size_t kMaxReportRows = 4'000'000;

struct ReportOptions {
  /// Of the errors and poses over time, and of the summary.
  evaluation::AlignmentMode alignment = evaluation::AlignmentMode::kInitScale;
  std::uint64_t max_bytes = kMaxReportBytes;
  std::size_t max_rows = kMaxReportRows;
  const std::atomic<bool>* cancel = nullptr;  ///< may be null
  OpenRunWorld open_world{};                  ///< as MapOptions::open_world
  /// Told each step, for people. May be empty.
  std::function<void(const std::string&)> notice{};
};

struct MadeReport {
  std::string html;  ///< equal for equal run folders, worlds and builds
  std::size_t runs = 0;
  std::size_t estimators = 0;
  std::vector<LeftOutRun> left_out;  ///< runs that cannot be reported, with the reason
};

/// Reads the runs and makes their report. Nothing is written.
/// Errors: kInvalidArgument for no run, more than kMaxRuns, or a report beyond max_bytes; the first
/// run's error if none can be reported; kCancelled.
[[nodiscard]] Result<MadeReport> make_report(const std::vector<std::filesystem::path>& run_folders,
                                             const ReportOptions& options = {});

/// Errors: kConflict if the file exists already.
[[nodiscard]] Status check_report_file(const std::filesystem::path& file);

/// The file appears whole or not at all, and never replaces another.
/// Errors: kConflict if it exists already; kIo.
[[nodiscard]] Status write_report(const std::filesystem::path& file, const std::string& html);

}  // namespace overfly::server::report
