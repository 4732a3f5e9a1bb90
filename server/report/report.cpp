#include "server/report/report.hpp"

#include <unistd.h>

#include <cstdio>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "core/cancel.hpp"
#include "core/text/number_text.hpp"
#include "core/text/shown_path.hpp"
#include "server/files/take_name.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/report/data_block.hpp"
#include "server/report/figures/time_figures.hpp"
#include "server/report/figures/track_figures.hpp"
#include "server/report/html_parts.hpp"
#include "server/report/plot/markup.hpp"
#include "server/report/plot/series.hpp"
#include "server/report/run/flight_groups.hpp"
#include "server/report/run/read_run.hpp"
#include "server/report/summary_section.hpp"
#include "server/report/tables_section.hpp"

namespace overfly::server::report {
namespace {

namespace fs = std::filesystem;
using plot::escaped;

/// Estimators in one figure: more lines cannot be told apart.
constexpr std::size_t kMaxLines = 8;

/// The page as it grows, up to its limit.
class Page {
 public:
  explicit Page(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  void add(const std::string& markup) {
    if (!too_large()) html_ += markup;
  }
  [[nodiscard]] bool too_large() const { return html_.size() > max_bytes_; }
  [[nodiscard]] std::string html() && { return std::move(html_); }

 private:
  std::uint64_t max_bytes_;
  std::string html_;
};

std::string mebibytes_text(std::uint64_t bytes) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g MiB", static_cast<double>(bytes) / (1U << 20U));
  return text;
}

Error too_large(const ReportContent& content, std::uint64_t max_bytes) {
  return {ErrorCode::kInvalidArgument,
          "the report of " + counted(content.runs.size(), "run") + " is larger than " +
              mebibytes_text(max_bytes) + ", the limit: report fewer runs in one file"};
}

Error report_cancelled() { return {ErrorCode::kCancelled, "the report was cancelled"}; }

Error too_many_rows(const fs::path& folder,
                    std::size_t rows,
                    std::size_t earlier,
                    std::size_t max_rows) {
  return {ErrorCode::kInvalidArgument,
          folder.string() + ": its " + std::to_string(rows) + " frames and answers, with " +
              std::to_string(earlier) + " of the runs before it, are more than " +
              std::to_string(max_rows) + ", the limit of one report: report it in another file"};
}

/// Why a run was left out, for other people: without the folders of this machine.
std::string shown_reason(const fs::path& folder, const std::string& message) {
  return folder.is_absolute() ? shown_without(folder.parent_path(), "", message) : message;
}

/// Reads what can be read. Errors: as make_report.
Result<ReportContent> read_content(const std::vector<fs::path>& folders,
                                   const ReportOptions& options) {
  ReportContent content;
  content.alignment = options.alignment;
  std::optional<Error> first;
  std::size_t rows = 0;
  for (const fs::path& folder : folders) {
    if (is_cancelled(options.cancel)) return report_cancelled();
    if (options.notice) options.notice("reading " + folder.string());
    Result<ReportRun> run = read_report_run(folder, options.alignment);
    if (run && run->rows() > options.max_rows - rows) {
      run = too_many_rows(folder, run->rows(), rows, options.max_rows);
    }
    if (run) {
      rows += run->rows();
      content.runs.push_back(std::move(*run));
      continue;
    }
    content.left_out.push_back({folder_name(folder), shown_reason(folder, run.error().message)});
    if (!first) first = run.error();
  }
  if (content.runs.empty()) return *first;
  if (folders.size() > 1) {
    for (std::size_t i = 0; i < content.runs.size(); ++i) {
      content.runs[i].label = "run " + std::to_string(i + 1);
    }
  }
  content.groups = flight_groups(content.runs);
  return content;
}

std::string title_of(const ReportContent& content) {
  std::set<std::string> titles;
  for (const ReportRun& run : content.runs) {
    titles.insert(run.info.title.empty() ? run.info.scenario : run.info.title);
  }
  if (titles.size() == 1 && !titles.begin()->empty()) return *titles.begin();
  return counted(content.runs.size(), "run");
}

std::string head_of(const ReportContent& content) {
  const std::string title = escaped(title_of(content), 200);
  const std::string program = escaped(program_text());
  std::string markup = page_start(title_of(content) + " - Overfly report") + "<header>\n<h1>" +
                       title + "</h1>\n<p class=\"lead\">Report of Overfly " + program + " on " +
                       escaped(counted(content.runs.size(), "run")) +
                       "</p>\n<nav aria-label=\"Sections\">";
  const auto link = [&](const char* id, const char* text) {
    markup += std::string("<a href=\"#") + id + "\">" + text + "</a>";
  };
  link("summary", "Summary");
  if (content.runs.size() > 1) link("differences", "Differences");
  link("flight-1", "Figures");
  link("scores", "All scores");
  link("provenance", "Provenance");
  return markup + "</nav>\n</header>\n<main>\n";
}

/// Entries for one set of figures each: runs of one flight, at most kMaxLines estimators unless one
/// run has more.
std::vector<std::vector<std::size_t>> figure_sets(const ReportContent& content) {
  std::vector<std::vector<std::size_t>> sets;
  for (const std::vector<std::size_t>& group : content.groups) {
    std::size_t lines = 0;
    sets.emplace_back();
    for (const std::size_t index : group) {
      const std::size_t own = content.runs[index].estimates.size();
      if (!sets.back().empty() && lines + own > kMaxLines) {
        sets.emplace_back();
        lines = 0;
      }
      sets.back().push_back(index);
      lines += own;
    }
  }
  return sets;
}

std::string set_title(const ReportContent& content, const std::vector<std::size_t>& set) {
  std::string runs;
  for (const std::size_t index : set) {
    const std::string& label = content.runs[index].label;
    if (!label.empty()) runs += (runs.empty() ? "" : ", ") + label;
  }
  if (runs.empty()) return "The flight";
  return (set.size() > 1 ? "One flight: " : "The flight of ") + runs;
}

Status add_figures(const ReportContent& content, const ReportOptions& options, Page& page) {
  const auto sets = figure_sets(content);
  for (std::size_t i = 0; i < sets.size() && !page.too_large(); ++i) {
    const ReportRun& run = content.runs[sets[i].front()];
    const std::vector<ReportEntry> entries = entries_of(content, sets[i]);
    const std::string id = "flight-" + std::to_string(i + 1);
    if (options.notice) options.notice("drawing " + run.id);
    const Result<std::string> tracks =
        track_figures(content, run, entries, id, {options.open_world, options.cancel});
    if (!tracks) return tracks.error();
    page.add("<section id=\"" + id + "\">\n" + heading(2, set_title(content, sets[i])));
    page.add(*tracks);
    page.add(time_figures(content, run, entries, id) + "</section>\n");
  }
  return {};
}

std::string footer_of(const ReportContent& content) {
  std::set<std::string> credits;
  for (const ReportRun& run : content.runs) {
    if (!run.info.attribution.empty()) credits.insert(run.info.attribution);
  }
  std::string markup = "</main>\n<footer>\n";
  for (const std::string& credit : credits) markup += paragraph("Imagery and elevation: " + credit);
  return markup +
         paragraph(
             "This file is complete: it loads nothing and runs no script. The exact numbers are in "
             "its block overfly-report, as JSON. Lines have at most " +
             std::to_string(plot::kMaxPoints) + " points, which keep every peak.") +
         "</footer>\n";
}

}  // namespace

Result<MadeReport> make_report(const std::vector<fs::path>& run_folders,
                               const ReportOptions& options) {
  if (run_folders.empty() || run_folders.size() > kMaxRuns) {
    return Error{ErrorCode::kInvalidArgument,
                 "runs = " + std::to_string(run_folders.size()) + ": must be 1 to " +
                     std::to_string(kMaxRuns)};
  }
  const Result<ReportContent> content = read_content(run_folders, options);
  if (!content) return content.error();
  Page page(options.max_bytes);
  page.add(head_of(*content));
  page.add(summary_section(*content));
  page.add(differences_section(*content));
  if (Status status = add_figures(*content, options, page); !status) return status.error();
  page.add(scores_section(*content));
  page.add(provenance_section(*content));
  page.add(footer_of(*content));
  page.add(data_block(report_data(*content)));
  page.add("</body>\n</html>\n");
  if (page.too_large()) return too_large(*content, options.max_bytes);
  MadeReport made;
  made.html = std::move(page).html();
  made.runs = content->runs.size();
  for (const ReportRun& run : content->runs) made.estimators += run.estimates.size();
  made.left_out = content->left_out;
  return made;
}

Status check_report_file(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(file, ignored))) return {};
  return Error{ErrorCode::kConflict, file.string() + ": exists already"};
}

Status write_report(const fs::path& file, const std::string& html) {
  const fs::path unfinished = file.string() + ".unfinished-" + std::to_string(::getpid());
  if (Status status = write_whole(unfinished, html); !status) return status;
  const Result<bool> taken = take_free_name(unfinished, file);
  std::error_code ignored;
  if (taken && *taken) return {};
  fs::remove(unfinished, ignored);
  if (!taken) return taken.error();
  return Error{ErrorCode::kConflict, file.string() + ": exists already"};
}

}  // namespace overfly::server::report
