// overfly compare: two sweeps, for the continuous integration of an estimator.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/text/number_text.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/output_files.hpp"
#include "server/app/score_table.hpp"
#include "server/experiments/comparison/compare_sweeps.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::app {
namespace {

namespace experiments = server::experiments;

struct CompareArguments {
  std::string sweep;
  std::string baseline;
  std::vector<std::string> conditions;
  std::string estimator;
  std::string alignment = "init_scale";
  std::string junit;
};

Result<std::vector<experiments::Condition>> parsed_conditions(
    const std::vector<std::string>& texts) {
  std::vector<experiments::Condition> conditions;
  for (const std::string& text : texts) {
    Result<experiments::Condition> condition = experiments::Condition::parse(text);
    if (!condition) return condition.error();
    conditions.push_back(std::move(*condition));
  }
  return conditions;
}

/// @return whether the condition holds or cannot be evaluated
bool print_judged(const experiments::JudgedCondition& condition) {
  if (!condition.verdict) {
    std::cout << "error   " << condition.text << ": " << condition.verdict.error().message << "\n";
    return true;
  }
  std::cout << (condition.verdict->holds ? "FAILED  " : "passed  ") << condition.text << "  ("
            << number_text(condition.verdict->left) << " against "
            << number_text(condition.verdict->right) << ")\n";
  return condition.verdict->holds;
}

Status write_junit(const CompareArguments& arguments,
                   const std::vector<experiments::JudgedCondition>& judged) {
  if (arguments.junit.empty()) return {};
  Status status = server::write_whole(arguments.junit, experiments::junit_from(judged));
  return status ? status : status.error().in("--junit");
}

/// Without pairs no condition can be evaluated.
int report_no_pairs(const CompareArguments& arguments) {
  const Error none{ErrorCode::kNotFound,
                   arguments.sweep + " and " + arguments.baseline + ": " + experiments::kNoPairs};
  std::vector<experiments::JudgedCondition> judged;
  for (const std::string& condition : arguments.conditions) judged.push_back({condition, none});
  if (Status status = write_junit(arguments, judged); !status) (void)report(status.error());
  return report(none);
}

int compare(const CompareArguments& arguments) {
  std::vector<NamedFile> read = files_of_sweep(arguments.sweep);
  for (NamedFile& file : files_of_sweep(arguments.baseline)) read.push_back(std::move(file));
  if (Status status = check_outputs({{"--junit", arguments.junit}}, read); !status) {
    return report(status.error());
  }
  const auto conditions = parsed_conditions(arguments.conditions);
  if (!conditions) return report(conditions.error());
  const auto mode = evaluation::alignment_mode_from(arguments.alignment).value();
  const auto paired =
      experiments::pair_sweeps(arguments.sweep, arguments.baseline, arguments.estimator, mode);
  if (!paired) return report(paired.error());
  if (paired->pairs == 0) return report_no_pairs(arguments);
  std::cout << counted(paired->pairs, "flight") << " in both sweeps; " << paired->without_pair
            << " without a pair and " << paired->failed << " that failed are left out\n";
  std::vector<experiments::JudgedCondition> judged;
  bool failed = false;
  for (const experiments::Condition& condition : *conditions) {
    judged.push_back({condition.text(), condition.evaluate(paired->flights, paired->baseline)});
    failed = print_judged(judged.back()) || failed;
  }
  if (Status status = write_junit(arguments, judged); !status) {
    // Not kExitFailure, which says that a condition holds.
    (void)report(status.error());
    return kExitUsage;
  }
  return failed ? kExitFailure : kExitOk;
}

}  // namespace

void add_compare_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand(
      "compare", "Compare two sweeps and fail on conditions, for continuous integration");
  command->add_option("sweep", arguments->sweep, "Folder of a sweep")->required();
  command->add_option("baseline", arguments->baseline, "Folder of the sweep to compare with")
      ->required();
  command
      ->add_option("--fail-if",
                   arguments->conditions,
                   "Condition, e.g. 'median(position_rmse_m) > 1.1 * baseline'")
      ->required()
      ->allow_extra_args(false);
  command->add_option("--estimator", arguments->estimator, "Only flights of this estimator");
  command->add_option("--alignment", arguments->alignment, "Alignment of the errors")
      ->check(CLI::IsMember(alignment_mode_names()))
      ->capture_default_str();
  command->add_option("--junit", arguments->junit, "Write the results as JUnit XML to this file");
  command->callback([arguments, &exit_code] { exit_code = compare(*arguments); });
}

}  // namespace overfly::app
