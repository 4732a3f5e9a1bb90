// overfly scenario: lists, checks and prints scenarios.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/install_paths.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_list.hpp"
#include "server/scenario/document/scenario_schema.hpp"

namespace overfly::app {
namespace {

int list(const std::string& folder) {
  const std::filesystem::path listed =
      folder.empty() ? scenarios_folder() : std::filesystem::path(folder);
  std::error_code ignored;
  if (!std::filesystem::is_directory(listed, ignored)) {
    return report({ErrorCode::kNotFound, listed.string() + ": no such folder"});
  }
  for (const server::ScenarioEntry& entry : server::list_scenarios(listed)) {
    std::cout << entry.name << ": " << entry.title << "\n";
    if (!entry.error.empty()) std::cout << "  cannot be flown here: " << entry.error << "\n";
  }
  return kExitOk;
}

int validate(const std::vector<std::string>& files) {
  int exit_code = kExitOk;
  for (const std::string& file : files) {
    const Result<server::Scenario> scenario = server::load_scenario(file);
    Status status = scenario ? server::check_scenario(*scenario) : Status{scenario.error()};
    if (status) {
      std::cout << file << ": valid\n";
    } else {
      exit_code = report(scenario ? status.error().in(file) : status.error());
    }
  }
  return exit_code;
}

int show(const std::string& file) {
  const Result<server::Scenario> scenario = server::load_scenario(file);
  if (!scenario) return report(scenario.error());
  std::cout << scenario->resolved.dump(2) << "\n";
  return kExitOk;
}

}  // namespace

void add_scenario_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("scenario", "List, check and print scenarios");
  command->require_subcommand(1);
  const auto folder = std::make_shared<std::string>();
  CLI::App* lists = command->add_subcommand("list", "Names and titles of a folder's scenarios");
  lists->add_option("folder", *folder, "Folder; default: the program's own");
  lists->callback([folder, &exit_code] { exit_code = list(*folder); });

  const auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* checks = command->add_subcommand("validate", "Check files: schema, limits, data");
  checks->add_option("files", *files, "Scenario files")->required();
  checks->callback([files, &exit_code] { exit_code = validate(*files); });

  const auto file = std::make_shared<std::string>();
  CLI::App* shows = command->add_subcommand("show", "Print one with its defaults filled in");
  shows->add_option("file", *file, "Scenario file")->required();
  shows->callback([file, &exit_code] { exit_code = show(*file); });

  CLI::App* schema = command->add_subcommand("schema", "Print the JSON schema");
  schema->callback([&exit_code] {
    std::cout << server::scenario_schema_text();
    exit_code = kExitOk;
  });
}

}  // namespace overfly::app
