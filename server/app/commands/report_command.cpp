// overfly report: one HTML file about one or several runs.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "core/text/number_text.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/progress.hpp"
#include "server/app/score_table.hpp"
#include "server/app/stop_signal.hpp"
#include "server/report/report.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;

struct ReportArguments {
  std::vector<std::string> runs;
  std::string out;
  std::string alignment = "init_scale";
  bool quiet = false;
};

Result<server::report::MadeReport> make(const ReportArguments& arguments) {
  ProgressDisplay display(arguments.quiet);
  server::report::ReportOptions options;
  options.alignment = evaluation::alignment_mode_from(arguments.alignment).value();
  options.cancel = &catch_stop_signals();
  options.notice = [&display](const std::string& text) { display.note(text); };
  return server::report::make_report({arguments.runs.begin(), arguments.runs.end()}, options);
}

int write_report_of(const ReportArguments& arguments) {
  const fs::path file = arguments.out;
  if (Status status = server::report::check_report_file(file); !status) {
    return report(status.error());
  }
  const Result<server::report::MadeReport> made = make(arguments);
  if (!made) return report(made.error());
  for (const server::report::LeftOutRun& run : made->left_out) {
    std::cerr << "warning: " << run.name << " is not in the report: " << run.reason << "\n";
  }
  if (Status status = server::report::write_report(file, made->html); !status) {
    return report(status.error());
  }
  std::cout << arguments.out << ": " << counted(made->runs, "run") << ", "
            << counted(made->estimators, "estimator") << ", " << (made->html.size() + 1023) / 1024
            << " KiB\n";
  return kExitOk;
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand("report", "Write one HTML file about one or several runs");
  command->add_option("runs", arguments->runs, "Run folders")->required();
  command->add_option("--out", arguments->out, "HTML file to create")->required();
  command
      ->add_option("--alignment",
                   arguments->alignment,
                   "Alignment of the estimates in summary and figures; tables have all")
      ->check(CLI::IsMember(alignment_mode_names()))
      ->capture_default_str();
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->callback([arguments, &exit_code] { exit_code = write_report_of(*arguments); });
}

}  // namespace overfly::app
