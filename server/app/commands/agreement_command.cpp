// overfly agreement: how the real images of a run agree with the virtual ones.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/score_table.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/rows/agreement_rows.hpp"
#include "server/record/run_folder.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scoring/agreement_report.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::app {
namespace {

using server::AgreementReport;
using server::FigureSummary;

struct AgreementArguments {
  std::string run;
  bool json = false;
};

struct ReadAgreement {
  AgreementReport report;
  server::RunMetrics metrics;
};

Result<ReadAgreement> read_run(const std::filesystem::path& folder) {
  Result<nlohmann::json> document = server::read_json(server::scenario_file(folder));
  if (!document) return document.error();
  const auto scenario = server::resolve_scenario(std::move(*document), {}, folder);
  if (!scenario) return scenario.error().in(server::scenario_file(folder).string());
  const auto rows = server::read_agreement(folder);
  if (!rows) return rows.error();
  Result<AgreementReport> report = server::report_agreement(*scenario, *rows);
  if (!report) return report.error().in(folder.string());
  Result<server::RunMetrics> metrics = server::read_run_metrics(folder);
  if (!metrics) return metrics.error();
  return ReadAgreement{std::move(*report), std::move(*metrics)};
}

std::string line_of(const char* what,
                    const std::optional<FigureSummary>& figure,
                    const char* format) {
  std::string text = what;
  text.resize(28, ' ');
  if (!figure) return text + "          -          -          -\n";
  for (const double value : {figure->median, figure->p5, figure->p95}) {
    char number[40];
    std::snprintf(number, sizeof number, format, value);
    text += number;
  }
  return text + "\n";
}

std::string table_of(const ReadAgreement& read) {
  const AgreementReport& report = read.report;
  char offset[100] = "-\n";
  if (report.mean_offset_px) {
    std::snprintf(offset,
                  sizeof offset,
                  "%.3f px right, %.3f px down\n",
                  report.mean_offset_px->x(),
                  report.mean_offset_px->y());
  }
  std::string text =
      "real images of " + report.real_camera + ", virtual ones of " + report.virtual_camera + "\n" +
      std::to_string(report.frames) + " frames, " + std::to_string(report.lost) + " images lost, " +
      std::to_string(report.missing) + " missing in the stream, " +
      std::to_string(report.not_comparable) + " not comparable (uniform)\nmean offset " + offset;
  text += "                                median        5 %       95 %\n";
  text += line_of("offset [px]", report.offset_px, "%11.3f");
  text += line_of("correlation", report.correlation, "%11.4f");
  text += line_of("correlation, offset removed", report.correlation_aligned, "%11.4f");
  text += line_of("peak of phase correlation", report.peak, "%11.3f");
  text += line_of("corners, real", report.corners_real, "%11.0f");
  text += line_of("corners, virtual", report.corners_virtual, "%11.0f");
  for (const server::EstimatorPair& pair : report.estimators) {
    text += "same estimator: " + pair.real + " (real), " + pair.rendered + " (virtual)\n";
  }
  return text + score_table(read.metrics, evaluation::AlignmentMode::kSim3);
}

int show_agreement(const AgreementArguments& arguments) {
  const Result<ReadAgreement> read = read_run(arguments.run);
  if (!read) return report(read.error());
  if (arguments.json) {
    std::cout << json_from(read->report, read->metrics).dump(2) << "\n";
  } else {
    std::cout << table_of(*read);
  }
  return 0;
}

}  // namespace

void add_agreement_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "agreement", "Report how the real images of a run agree with the virtual ones");
  auto arguments = std::make_shared<AgreementArguments>();
  command->add_option("run", arguments->run, "Run folder")->required();
  command->add_flag("--json", arguments->json, "Print JSON");
  command->callback([arguments, &exit_code] { exit_code = show_agreement(*arguments); });
}

}  // namespace overfly::app
