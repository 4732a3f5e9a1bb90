// overfly table: the results of a sweep as tables.
#include <CLI/CLI.hpp>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/output_files.hpp"
#include "server/experiments/tables/sweep_tables.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::app {
namespace {

namespace experiments = server::experiments;

struct TableArguments {
  std::string folder;
  std::string format = "markdown";
  std::string out;
  std::string published;
  std::vector<std::string> counterparts;
  double margin_percent = 10.0;
};

Result<experiments::TableOptions> table_options_from(const TableArguments& arguments) {
  experiments::TableOptions options;
  options.differences.margin = arguments.margin_percent / 100.0;
  if (!arguments.published.empty()) {
    Result<experiments::PublishedErrors> published =
        experiments::read_published_errors(arguments.published);
    if (!published) return published.error();
    options.published = std::move(*published);
  }
  for (const std::string& text : arguments.counterparts) {
    const std::size_t sign = text.find('=');
    if (sign == std::string::npos) {
      return Error{ErrorCode::kInvalidArgument,
                   "--as " + text + ": must be ESTIMATOR=PUBLISHED_NAME"};
    }
    options.counterparts[text.substr(0, sign)] = text.substr(sign + 1);
  }
  return options;
}

int table(const TableArguments& arguments) {
  std::vector<NamedFile> read = files_of_sweep(arguments.folder);
  read.push_back({"--published", arguments.published});
  if (Status status = check_outputs({{"--out", arguments.out}}, read); !status) {
    return report(status.error());
  }
  const Result<experiments::TableOptions> options = table_options_from(arguments);
  if (!options) return report(options.error());
  Result<experiments::SweepScores> scores = experiments::read_sweep_scores(arguments.folder);
  if (!scores) return report(scores.error());
  const auto tables = experiments::sweep_tables(std::move(*scores), *options);
  if (!tables) return report(tables.error());
  const std::string text = experiments::text_from(
      *tables, *options, experiments::table_format_from(arguments.format).value());
  if (arguments.out.empty()) {
    std::cout << text;
    return kExitOk;
  }
  if (Status status = server::write_whole(arguments.out, text); !status) {
    return report(status.error());
  }
  return kExitOk;
}

}  // namespace

void add_table_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<TableArguments>();
  CLI::App* command =
      app.add_subcommand("table", "Tables of a sweep: errors, outcomes, differences");
  command->add_option("sweep", arguments->folder, "Folder of a sweep")->required();
  command->add_option("--format", arguments->format, "markdown, latex, html, csv or json")
      ->check(CLI::IsMember({"markdown", "latex", "html", "csv", "json"}))
      ->capture_default_str();
  command->add_option("--out", arguments->out, "Write to this file instead of the standard output");
  command->add_option("--published",
                      arguments->published,
                      "Show the errors of this file next to the sweep's (JSON)");
  command
      ->add_option("--as",
                   arguments->counterparts,
                   "ESTIMATOR=PUBLISHED_NAME: which estimators to compare with published ones")
      ->allow_extra_args(false);
  command
      ->add_option("--margin-percent",
                   arguments->margin_percent,
                   "Differences within this share of the second estimator's median are practically "
                   "equal")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = table(*arguments); });
}

}  // namespace overfly::app
