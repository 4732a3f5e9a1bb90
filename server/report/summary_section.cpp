#include "server/report/summary_section.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/text/number_text.hpp"
#include "core/text/percent.hpp"
#include "core/time.hpp"
#include "server/report/best_values.hpp"
#include "server/report/html_parts.hpp"
#include "server/report/plot/markup.hpp"
#include "server/report/run/words.hpp"

namespace overfly::server::report {
namespace {

using evaluation::AlignmentMode;
using evaluation::AlignmentScore;
using evaluation::Outcome;
using plot::escaped;

/// Of a time as text, up to its seconds: "2026-11-21T09:12:04".
constexpr std::size_t kSecondsLength = 19;

/// True if its errors may be compared with those of others: it completed the flight, and it was not
/// given the truth.
bool competes(const ReportEntry& entry) {
  return entry.metrics().score.outcome == Outcome::kCompleted && !entry.metrics().test_estimator;
}

/// The quantities that are compared, in the order of the table's columns.
struct Figures {
  std::optional<double> coverage;
  std::optional<double> position_m;
  std::optional<double> horizontal_m;
  std::optional<double> vertical_m;
  std::optional<double> path_percent;
  std::optional<double> rotation_deg;
  std::optional<double> latency_ms;
};

Figures figures_of(const ReportEntry& entry, AlignmentMode mode) {
  Figures figures;
  figures.coverage = entry.metrics().score.coverage;
  if (entry.estimate->status.latency) {
    figures.latency_ms = entry.estimate->status.latency->median_ms;
  }
  const AlignmentScore* aligned = entry.aligned(mode);
  if (aligned == nullptr) return figures;
  figures.position_m = aligned->position_m.rmse;
  figures.path_percent = percent_of_path(*entry.run, aligned->position_m.rmse);
  if (aligned->rotation_deg) figures.rotation_deg = aligned->rotation_deg->rmse;
  const auto parts = entry.estimate->axis_rmse.find(mode);
  if (parts != entry.estimate->axis_rmse.end()) {
    figures.horizontal_m = parts->second.horizontal_m;
    figures.vertical_m = parts->second.vertical_m;
  }
  return figures;
}

/// Which entries have the best value of a quantity.
std::vector<bool> best_entries(const std::vector<ReportEntry>& entries,
                               const std::vector<Figures>& figures,
                               std::optional<double> Figures::*quantity,
                               bool largest) {
  std::vector<std::optional<double>> values;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    values.push_back(competes(entries[i]) ? figures[i].*quantity : std::nullopt);
  }
  return best_of(values, largest);
}

void add_rows(const std::vector<ReportEntry>& entries,
              AlignmentMode mode,
              std::vector<std::vector<Cell>>& rows) {
  std::vector<Figures> figures;
  for (const ReportEntry& entry : entries) figures.push_back(figures_of(entry, mode));
  const auto best = [&](std::optional<double> Figures::*quantity, bool largest = false) {
    return best_entries(entries, figures, quantity, largest);
  };
  const auto coverage = best(&Figures::coverage, true);
  const auto position = best(&Figures::position_m);
  const auto horizontal = best(&Figures::horizontal_m);
  const auto vertical = best(&Figures::vertical_m);
  const auto path = best(&Figures::path_percent);
  const auto rotation = best(&Figures::rotation_deg);
  const auto latency = best(&Figures::latency_ms);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const ReportEntry& entry = entries[i];
    const AlignmentScore* aligned = entry.aligned(mode);
    const Figures& own = figures[i];
    rows.push_back(
        {{name_of(*entry.run, *entry.estimate)},
         {outcome_text(entry.metrics().score)},
         {percent_text(entry.metrics().score.coverage), true, coverage[i]},
         {figure_text(own.position_m), true, position[i]},
         {figure_text(own.horizontal_m), true, horizontal[i]},
         {figure_text(own.vertical_m), true, vertical[i]},
         {figure_text(own.path_percent), true, path[i]},
         {figure_text(own.rotation_deg), true, rotation[i]},
         {aligned == nullptr ? figure_text(std::nullopt) : figure_text(aligned->S_world_vo.scale),
          true},
         {figure_text(own.latency_ms), true, latency[i]},
         {std::to_string(entry.metrics().dropped_frames), true}});
  }
}

std::string scores_table(const ReportContent& content) {
  Table scores;
  scores.caption = std::string("Root mean square errors by the alignment ") +
                   evaluation::to_string(content.alignment) +
                   ". A star marks the best of each flight among the estimators that completed it; "
                   "test estimators, which are given the truth, take no part.";
  scores.head = {{"estimator"},
                 {"outcome"},
                 {"coverage", true},
                 {"position [m]", true},
                 {"horizontal [m]", true},
                 {"vertical [m]", true},
                 {"of the path [%]", true},
                 {"rotation [deg]", true},
                 {"scale", true},
                 {"median latency [ms]", true},
                 {"dropped frames", true}};
  for (const std::vector<std::size_t>& group : content.groups) {
    add_rows(entries_of(content, group), content.alignment, scores.rows);
  }
  return scores.rows.empty() ? "" : table(scores);
}

/// " It is overconfident: ..." of an estimator that states covariances.
std::string honesty_words(const AlignmentScore& aligned) {
  if (!aligned.consistency || !aligned.consistency->honesty()) return "";
  const evaluation::Consistency& consistency = *aligned.consistency;
  const evaluation::Honesty honesty = *consistency.honesty();
  if (honesty == evaluation::Honesty::kConsistent) {
    return " Its errors agree with the covariances that it states.";
  }
  std::string text = " It is " + std::string(evaluation::to_string(honesty)) + ":";
  const char* separator = " ";
  for (const auto& [part, nees] :
       {std::pair("position", consistency.position), std::pair("rotation", consistency.rotation)}) {
    if (!nees) continue;
    text += std::string(separator) + "its errors of the " + part + " are " +
            figure_text(nees->deviation_ratio()) + " times the stated deviations";
    separator = ", ";
  }
  return text + ".";
}

std::string errors_words(const ReportEntry& entry, AlignmentMode mode) {
  const AlignmentScore* aligned = entry.aligned(mode);
  const std::string name = evaluation::to_string(mode);
  if (aligned == nullptr) {
    const auto& unavailable = entry.metrics().score.unavailable;
    const auto reason = unavailable.find(mode);
    return reason == unavailable.end() ? "" : " No " + name + " alignment: " + reason->second + ".";
  }
  const Figures figures = figures_of(entry, mode);
  std::string text = " By " + name + " (scale " + figure_text(aligned->S_world_vo.scale) +
                     ") its position is off by " + figure_text(figures.position_m) + " m RMSE";
  if (figures.path_percent) text += " (" + figure_text(figures.path_percent) + " % of the path)";
  text += ", " + figure_text(figures.horizontal_m) + " m horizontally and " +
          figure_text(figures.vertical_m) + " m vertically";
  text += figures.rotation_deg ? ", its rotation by " + figure_text(figures.rotation_deg) + " deg."
                               : "; the path does not determine its rotation.";
  text += honesty_words(*aligned);
  for (const std::string& note : aligned->notes) text += " Note: " + note + ".";
  return text;
}

/// ", 7.2 % more" than that of the alignment that is shown.
std::string scale_change_words(const AlignmentScore* shown, const AlignmentScore& fitted) {
  if (shown == nullptr || !(shown->S_world_vo.scale > 0.0)) return "";
  const double change = fitted.S_world_vo.scale / shown->S_world_vo.scale - 1.0;
  if (!std::isfinite(change)) return "";
  return ", " + figure_text(100.0 * std::abs(change)) + " % " + (change < 0.0 ? "less" : "more");
}

std::string entry_words(const ReportEntry& entry, AlignmentMode mode) {
  const EstimatorMetrics& metrics = entry.metrics();
  std::string text =
      outcome_words(metrics) + " and tracked " + percent_text(metrics.score.coverage) + " of " +
      counted(static_cast<std::uint64_t>(std::max(0, metrics.score.frames)), "frame") + ".";
  const std::string relocalised = relocalised_words(metrics.score);
  if (!relocalised.empty()) text += " It " + relocalised + ".";
  if (metrics.test_estimator) text += " It is a test estimator, which is given the truth.";
  if (metrics.crash) text += " Reason: " + *metrics.crash + ".";
  const std::string then = circumstances(*entry.run, *entry.estimate);
  if (!then.empty()) text += " " + then;
  text += errors_words(entry, mode);
  if (mode != AlignmentMode::kSim3) {
    if (const AlignmentScore* fitted = entry.aligned(AlignmentMode::kSim3)) {
      text += " The best fit (sim3, scale " + figure_text(fitted->S_world_vo.scale) +
              scale_change_words(entry.aligned(mode), *fitted) + ") leaves " +
              figure_text(fitted->position_m.rmse) + " m.";
    }
  }
  if (const auto& latency = entry.estimate->status.latency) {
    text += " Latency: median " + figure_text(latency->median_ms) + " ms, 99 % within " +
            figure_text(latency->p99_ms) + " ms.";
  }
  if (metrics.dropped_frames > 0) {
    text += " It dropped " + counted(static_cast<std::uint64_t>(metrics.dropped_frames), "frame") +
            " because it was busy.";
  }
  return text;
}

std::string joined_names(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i];
  }
  return text;
}

/// Which estimators completed one flight, and the best of them.
std::string verdict(const std::vector<ReportEntry>& entries, AlignmentMode mode) {
  std::vector<std::string> completed;
  std::vector<std::optional<double>> positions;
  std::size_t scored = 0;
  for (const ReportEntry& entry : entries) {
    const bool counts = !entry.metrics().test_estimator;
    scored += counts ? 1 : 0;
    positions.push_back(competes(entry) ? figures_of(entry, mode).position_m : std::nullopt);
    if (competes(entry)) completed.push_back(name_of(*entry.run, *entry.estimate));
  }
  if (scored == 0) return entries.empty() ? "The run has no estimator." : "Only test estimators.";
  std::string text = std::to_string(completed.size()) + " of " + counted(scored, "estimator") +
                     " completed this flight";
  text += completed.empty() ? "." : ": " + joined_names(completed) + ".";
  const std::vector<bool> best = best_of(positions, false);
  const auto first = std::find(best.begin(), best.end(), true);
  if (first != best.end()) {
    const auto index = static_cast<std::size_t>(first - best.begin());
    text += " " + name_of(*entries[index].run, *entries[index].estimate) +
            " has the smallest position error: " + figure_text(positions[index]) + " m RMSE by " +
            evaluation::to_string(mode) + ".";
  }
  return text;
}

/// "airfield course: 61.3 s, 1 530 m" of a run.
std::string flight_words(const ReportRun& run) {
  const std::string& title = run.info.title.empty() ? run.info.scenario : run.info.title;
  return title + " (" + figure_text(run.metrics.flight.duration_s) + " s, " +
         figure_text(run.metrics.flight.path_length_m) + " m flown, " +
         counted(run.main_frames().size(), "frame") + ", " + run.info.pacing + ")";
}

std::string run_line(const ReportRun& run) {
  std::string text = run.label.empty() ? "" : "<b>" + escaped(run.label) + "</b>: ";
  text += escaped(flight_words(run)) + ", <code>" + escaped(run.id) + "</code>";
  if (!run.info.created_utc.empty()) {
    text += ", requested " + escaped(run.info.created_utc.substr(0, kSecondsLength)) + " UTC";
  }
  return text;
}

std::string group_words(const ReportContent& content, const std::vector<std::size_t>& group) {
  std::string markup = "<div class=\"flight\">\n<ul class=\"runs\">\n";
  for (const std::size_t index : group) {
    markup += "<li>" + run_line(content.runs[index]) + "</li>\n";
  }
  return markup + "</ul>\n" +
         paragraph(verdict(entries_of(content, group), content.alignment), "verdict") + "</div>\n";
}

/// What each estimator did, and under which circumstances.
std::string accounts_of(const ReportContent& content) {
  std::string items;
  for (const std::vector<std::size_t>& group : content.groups) {
    for (const ReportEntry& entry : entries_of(content, group)) {
      items += "<li><b>" + escaped(name_of(*entry.run, *entry.estimate)) + "</b> " +
               escaped(entry_words(entry, content.alignment)) + "</li>\n";
    }
  }
  return items.empty() ? "" : heading(3, "In words") + "<ul>\n" + items + "</ul>\n";
}

std::string warning_item(const ReportWarning& warning) {
  const std::string level =
      warning.level == "error" || warning.level == "note" ? warning.level : "warning";
  std::string text = "<li class=\"" + level + "\"><b>" + level + "</b> ";
  if (!warning.source.empty()) text += "<i>" + escaped(warning.source) + "</i> ";
  text += escaped(warning.text, 1000);
  if (warning.first_s) {
    text +=
        escaped(" (" + std::string(warning.lines > 1 ? "first " : "") + "at " +
                figure_text(*warning.first_s) + " s" +
                (warning.lines > 1 ? ", " + std::to_string(warning.lines) + " times" : "") + ")");
  }
  return text + "</li>\n";
}

std::string warnings_of(const ReportContent& content) {
  std::string markup;
  for (const ReportRun& run : content.runs) {
    if (run.warnings.empty()) continue;
    markup += heading(3, run.label.empty() ? "Warnings" : "Warnings of " + run.label);
    markup += "<ul class=\"warnings\">\n";
    for (const ReportWarning& warning : run.warnings) markup += warning_item(warning);
    if (run.warnings_left_out > 0) {
      markup += "<li>" + escaped(counted(run.warnings_left_out, "further warning")) +
                " in the run's log</li>\n";
    }
    markup += "</ul>\n";
  }
  return markup;
}

std::string left_out_of(const ReportContent& content) {
  if (content.left_out.empty()) return "";
  std::string markup = heading(3, "Not in this report") + "<ul class=\"warnings\">\n";
  for (const LeftOutRun& run : content.left_out) {
    markup += "<li class=\"error\"><code>" + escaped(run.name) +
              "</code>: " + escaped(run.reason, 1000) + "</li>\n";
  }
  return markup + "</ul>\n";
}

}  // namespace

std::string summary_section(const ReportContent& content) {
  std::string markup = "<section id=\"summary\">\n" + heading(2, "Summary");
  for (const std::vector<std::size_t>& group : content.groups) {
    markup += group_words(content, group);
  }
  return markup + scores_table(content) + left_out_of(content) + accounts_of(content) +
         warnings_of(content) + "</section>\n";
}

}  // namespace overfly::server::report
