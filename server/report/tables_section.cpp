#include "server/report/tables_section.hpp"

#include <filesystem>

#include "core/text/number_text.hpp"
#include "server/record/comparison/compared_document.hpp"
#include "server/record/comparison/differences.hpp"
#include "server/record/run_manifest.hpp"
#include "server/report/html_parts.hpp"
#include "server/report/plot/markup.hpp"
#include "server/report/run/words.hpp"

namespace overfly::server::report {
namespace {

using evaluation::AlignmentMode;
using evaluation::AlignmentScore;
using Json = nlohmann::json;

constexpr std::size_t kMaxValueBytes = 400;
constexpr const char* kAbsent = "(absent)";
/// Rows of a table of fields; a document has some hundred.
constexpr std::size_t kMaxFields = 2000;

std::optional<double> rmse_figure(const std::optional<evaluation::ErrorStatistics>& errors) {
  return errors ? std::optional<double>(errors->rmse) : std::nullopt;
}

std::vector<Cell> score_row(const ReportEntry& entry,
                            AlignmentMode mode,
                            const AlignmentScore& aligned) {
  const evaluation::AxisRmse parts = [&] {
    const auto found = entry.estimate->axis_rmse.find(mode);
    return found == entry.estimate->axis_rmse.end() ? evaluation::AxisRmse{} : found->second;
  }();
  const auto number = [](const std::optional<double>& value) {
    return Cell{figure_text(value), true};
  };
  return {{name_of(*entry.run, *entry.estimate)},
          {outcome_text(entry.metrics().score)},
          {evaluation::to_string(mode)},
          number(aligned.S_world_vo.scale),
          {std::to_string(aligned.matched), true},
          number(aligned.position_m.rmse),
          number(percent_of_path(*entry.run, aligned.position_m.rmse)),
          number(parts.horizontal_m),
          number(parts.along_m),
          number(parts.across_m),
          number(parts.vertical_m),
          number(aligned.position_m.median),
          number(aligned.position_m.max),
          number(aligned.position_rmse_hold_m),
          number(rmse_figure(aligned.rotation_deg)),
          number(rmse_figure(aligned.rotation_euler_norm_deg)),
          number(aligned.position_auc)};
}

constexpr int kScoreColumns = 17;

void add_score_rows(const ReportEntry& entry, std::vector<std::vector<Cell>>& rows) {
  const evaluation::Score& score = entry.metrics().score;
  for (const AlignmentMode mode : evaluation::all_alignment_modes()) {
    if (const AlignmentScore* aligned = entry.aligned(mode)) {
      rows.push_back(score_row(entry, mode, *aligned));
    }
    const auto reason = score.unavailable.find(mode);
    if (reason != score.unavailable.end()) {
      rows.push_back({{name_of(*entry.run, *entry.estimate)},
                      {outcome_text(score)},
                      {evaluation::to_string(mode)},
                      {"X: " + reason->second, false, false, kScoreColumns - 3}});
    }
  }
}

std::string remarks_of(const ReportContent& content) {
  Table remarks;
  remarks.caption = "Remarks on alignments";
  remarks.head = {{"estimator"}, {"alignment"}, {"remark"}};
  for (const ReportRun& run : content.runs) {
    for (const ReportEstimate& estimate : run.estimates) {
      for (const auto& [mode, aligned] : run.metrics_of(estimate).score.alignments) {
        std::vector<std::string> texts = aligned.notes;
        if (aligned.degenerate) {
          texts.push_back("degenerate: " + *aligned.degenerate + "; no rotation error");
        }
        for (const std::string& text : texts) {
          remarks.rows.push_back({{name_of(run, estimate)}, {evaluation::to_string(mode)}, {text}});
        }
      }
    }
  }
  return remarks.rows.empty() ? "" : table(remarks);
}

std::string relative_table(const ReportContent& content) {
  Table relative;
  relative.caption =
      "Relative errors over segments of the true path (root mean squares over all segments of a "
      "length), by the alignment " +
      std::string(evaluation::to_string(content.alignment));
  relative.head = {{"estimator"},
                   {"length [m]", true},
                   {"segments", true},
                   {"translation [%]", true},
                   {"rotation [deg / 100 m]", true}};
  for (const ReportRun& run : content.runs) {
    for (const ReportEstimate& estimate : run.estimates) {
      const AlignmentScore* aligned = ReportEntry{&run, &estimate}.aligned(content.alignment);
      if (aligned == nullptr) continue;
      for (const evaluation::RelativeError& error : aligned->relative) {
        relative.rows.push_back({{name_of(run, estimate)},
                                 {figure_text(error.length_m), true},
                                 {std::to_string(error.pairs), true},
                                 {figure_text(error.translation_percent), true},
                                 {figure_text(error.rotation_deg_per_100m), true}});
      }
    }
  }
  return relative.rows.empty() ? "" : table(relative);
}

std::string range_text(const evaluation::Band& band) {
  return figure_text(band.low) + " to " + figure_text(band.high);
}

void add_nees_row(const std::string& name,
                  const char* part,
                  const std::optional<evaluation::Nees>& nees,
                  std::vector<std::vector<Cell>>& rows) {
  if (!nees) return;
  rows.push_back({{name},
                  {part},
                  {std::to_string(nees->samples), true},
                  {figure_text(nees->mean), true},
                  {std::to_string(nees->degrees), true},
                  {range_text(nees->band_95), true},
                  {figure_text(100.0 * nees->share_in_band), true},
                  {figure_text(nees->deviation_ratio()), true},
                  {evaluation::to_string(nees->honesty)}});
}

std::string honesty_table(const ReportContent& content) {
  Table honesty;
  honesty.caption =
      "Honesty of the covariances that estimators state, by the alignment " +
      std::string(evaluation::to_string(content.alignment)) +
      ": normalised estimation errors squared (NEES). An estimator is overconfident if their mean "
      "is above the band of 95 %, in which the mean of as many independent poses would lie; those "
      "of one flight are correlated, so that a mean slightly outside is no proof.";
  honesty.head = {{"estimator"},
                  {"part"},
                  {"poses", true},
                  {"mean NEES", true},
                  {"expected", true},
                  {"95 % band", true},
                  {"poses in their band of 95 % [%]", true},
                  {"errors / stated deviations", true},
                  {"mark"}};
  for (const ReportRun& run : content.runs) {
    for (const ReportEstimate& estimate : run.estimates) {
      const AlignmentScore* aligned = ReportEntry{&run, &estimate}.aligned(content.alignment);
      if (aligned == nullptr || !aligned->consistency) continue;
      const std::string name = name_of(run, estimate);
      add_nees_row(name, "position", aligned->consistency->position, honesty.rows);
      add_nees_row(name, "rotation", aligned->consistency->rotation, honesty.rows);
      add_nees_row(name, "pose", aligned->consistency->pose, honesty.rows);
    }
  }
  return honesty.rows.empty() ? "" : table(honesty);
}

/// One row for each interval that the path has, and one for the others.
void add_fix_drift_rows(const std::string& name,
                        const std::vector<evaluation::FixDrift>& drifts,
                        std::vector<std::vector<Cell>>& rows) {
  std::string missing;
  std::string reason;
  for (const evaluation::FixDrift& drift : drifts) {
    const std::string interval = number_text(1e-3 * drift.interval_m);
    if (!drift.unavailable.empty()) {
      missing += (missing.empty() ? "" : ", ") + interval;
      reason = drift.unavailable;
      continue;
    }
    rows.push_back({{name},
                    {interval, true},
                    {figure_text(drift.median_m), true},
                    {figure_text(drift.worst_m), true},
                    {figure_text(drift.horizontal_median_m), true},
                    {figure_text(drift.horizontal_worst_m), true},
                    {std::to_string(drift.segments), true},
                    {std::to_string(drift.apart), true}});
  }
  if (!missing.empty()) {
    rows.push_back({{name}, {missing, true}, {"X: " + reason, false, false, 6}});
  }
}

std::string fix_drift_table(const ReportContent& content) {
  Table drifts;
  drifts.caption =
      "Drift between position fixes: how far off the estimate is when the next fix comes, with a "
      "fix at every interval of the true path. A fix sets position and orientation to the truth; "
      "the scale is that of the alignment " +
      std::string(evaluation::to_string(content.alignment)) + ".";
  drifts.head = {{"estimator"},
                 {"interval [km]", true},
                 {"median [m]", true},
                 {"worst [m]", true},
                 {"horizontal median [m]", true},
                 {"horizontal worst [m]", true},
                 {"segments", true},
                 {"without overlap", true}};
  for (const ReportRun& run : content.runs) {
    for (const ReportEstimate& estimate : run.estimates) {
      const AlignmentScore* aligned = ReportEntry{&run, &estimate}.aligned(content.alignment);
      if (aligned == nullptr) continue;
      add_fix_drift_rows(name_of(run, estimate), aligned->fix_drift, drifts.rows);
    }
  }
  return drifts.rows.empty() ? "" : table(drifts);
}

std::string fields_table(const std::string& caption, const Json& document) {
  Table fields;
  fields.caption = caption;
  fields.fields = true;
  fields.head = {{"field"}, {"value"}};
  const auto leaves = leaves_of(document);
  for (const auto& [field, value] : leaves) {
    if (fields.rows.size() == kMaxFields) {
      fields.rows.push_back(
          {{"..."}, {counted(leaves.size() - kMaxFields, "further field") + " not shown"}});
      break;
    }
    fields.rows.push_back({{field}, {value}});
  }
  return table(fields);
}

std::string parameters_words(const RunManifest::Estimator& estimator) {
  if (!estimator.start_error.empty()) return "did not start: " + estimator.start_error;
  if (!estimator.parameters || estimator.parameters->empty()) return "none";
  std::string text;
  for (const auto& [name, value] : *estimator.parameters) {
    text += (text.empty() ? "" : ", ") + name + " = " + value;
  }
  if (estimator.parameters_at_end && estimator.parameters_at_end != estimator.parameters) {
    text += "; changed during the run";
  }
  return text;
}

/// The file's name without its folders, which say nothing on another machine.
std::string file_words(const RunManifest::WorldFile& file) {
  return std::filesystem::path(file.file).filename().string() + ": " + file.digest;
}

void add_world_rows(const RunManifest::World& world, std::vector<std::vector<Cell>>& rows) {
  rows.push_back({{"world"}, {world.name}});
  rows.push_back({{"attribution"}, {world.attribution}});
  if (world.manifest) rows.push_back({{"world manifest"}, {file_words(*world.manifest)}});
  for (const RunManifest::WorldFile& file : world.data_hashes) {
    rows.push_back({{"world data"}, {file_words(file)}});
  }
  if (!world.light.empty()) rows.push_back({{"light"}, {world.light}});
  if (!world.detail.empty()) rows.push_back({{"detail"}, {world.detail}});
}

Table origin_table(const ReportRun& run) {
  const RunManifest& manifest = run.manifest;
  Table origin;
  origin.caption = (run.label.empty() ? "" : run.label + ": ") + std::string("how it was made");
  origin.fields = true;
  origin.head = {{"what"}, {"value"}};
  origin.rows = {{{"run"}, {run.id}},
                 {{"status"}, {to_string(run.info.status)}},
                 {{"scenario"}, {manifest.scenario}},
                 {{"Overfly"}, {manifest.version + ", commit " + manifest.commit}},
                 {{"pacing"}, {manifest.pacing}},
                 {{"seed"}, {std::to_string(manifest.seed)}}};
  if (manifest.flight) origin.rows.push_back({{"flight"}, {manifest.flight->description}});
  if (manifest.renderer) {
    origin.rows.push_back(
        {{"renderer"}, {manifest.renderer->backend + ", " + manifest.renderer->device}});
  }
  if (manifest.world) add_world_rows(*manifest.world, origin.rows);
  for (const RunManifest::Camera& camera : manifest.cameras) {
    if (!camera.calibrated) continue;
    origin.rows.push_back({{"camera " + camera.name + ", as calibrated"},
                           {calibrated_words(*camera.calibrated, camera.model)}});
  }
  for (const RunManifest::Estimator& estimator : manifest.estimators) {
    origin.rows.push_back({{"estimator " + estimator.name},
                           {estimator.type + ", camera " + estimator.camera +
                            "; parameters: " + parameters_words(estimator)}});
  }
  return origin;
}

}  // namespace

std::string differences_section(const ReportContent& content) {
  if (content.runs.size() < 2) return "";
  std::vector<Json> documents;
  Table differing;
  differing.caption = "Fields of scenarios and manifests that are not the same in all runs";
  differing.fields = true;
  differing.head = {{"field"}};
  for (const ReportRun& run : content.runs) {
    documents.push_back(compared_document(run.manifest, run.scenario));
    differing.head.push_back({run.label});
  }
  const Differences differences = differences_between(documents);
  for (const Difference& difference : differences.fields) {
    std::vector<Cell>& row = differing.rows.emplace_back();
    row.push_back({difference.field});
    for (const auto& value : difference.values)
      row.push_back({value ? plot::clean_text(*value, kMaxValueBytes) : kAbsent});
  }
  std::string markup =
      "<section id=\"differences\">\n" + heading(2, "What differs between the runs");
  if (differing.rows.empty()) {
    markup += paragraph("Nothing: scenarios, program, world and parameters are the same.");
  } else {
    markup += table(differing);
  }
  if (differences.left_out > 0) {
    markup += paragraph(counted(differences.left_out, "further field") + " differ.");
  }
  return markup + "</section>\n";
}

std::string scores_section(const ReportContent& content) {
  Table scores;
  scores.caption =
      "Every estimator by every alignment. Errors are root mean squares unless stated otherwise; "
      "\"held\" holds the last pose to the end of the flight, \"Euler\" is the norm of the "
      "differences of roll, pitch and yaw, \"AUC\" the area under the curve of the share of the "
      "flight's frames whose position error is below a threshold of 0 to " +
      number_text(evaluation::Options().auc_limit_m) +
      " m, where frames without a pose count as errors above it: 1 is the best.";
  scores.head = {{"estimator"},
                 {"outcome"},
                 {"alignment"},
                 {"scale", true},
                 {"poses", true},
                 {"position [m]", true},
                 {"of the path [%]", true},
                 {"horizontal [m]", true},
                 {"along [m]", true},
                 {"across [m]", true},
                 {"vertical [m]", true},
                 {"median [m]", true},
                 {"max. [m]", true},
                 {"held [m]", true},
                 {"rotation [deg]", true},
                 {"Euler [deg]", true},
                 {"AUC", true}};
  for (const ReportRun& run : content.runs) {
    for (const ReportEstimate& estimate : run.estimates) {
      add_score_rows({&run, &estimate}, scores.rows);
    }
  }
  std::string markup = "<section id=\"scores\">\n" + heading(2, "All scores");
  markup += scores.rows.empty() ? paragraph("No estimator.") : table(scores);
  const std::string relative = relative_table(content);
  markup += honesty_table(content) + fix_drift_table(content);
  markup += remarks_of(content) + (relative.empty() ? "" : folded("Relative errors", relative));
  return markup + "</section>\n";
}

std::string provenance_section(const ReportContent& content) {
  std::string markup = "<section id=\"provenance\">\n" + heading(2, "Where the numbers come from");
  for (const ReportRun& run : content.runs) {
    const std::string of = run.label.empty() ? "" : " of " + run.label;
    markup += table(origin_table(run));
    markup += folded("Every field of the manifest" + of,
                     fields_table("manifest.json" + of, json_from(run.manifest)));
    markup +=
        folded("The scenario as flown" + of, fields_table("scenario.json" + of, run.scenario));
  }
  return markup + "</section>\n";
}

}  // namespace overfly::server::report
