// overfly doctor: reports what this machine lacks and how to fix it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>

#include "server/app/commands/commands.hpp"
#include "server/app/commands/doctor/doctor_camera.hpp"
#include "server/app/commands/doctor/doctor_checks.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/version.hpp"

namespace overfly::app {
namespace {

const char* mark_of(CheckLevel level) {
  if (level == CheckLevel::kOk) return "ok      ";
  return level == CheckLevel::kWarning ? "warning " : "FAULT   ";
}

int doctor(const std::string& runs, bool json) {
  const std::vector<Check> checks = all_checks(runs);
  const bool healthy = std::none_of(checks.begin(), checks.end(), [](const Check& check) {
    return check.level == CheckLevel::kFault;
  });
  if (json) {
    std::cout << json_from(checks).dump(2) << "\n";
    return healthy ? kExitOk : kExitUnsupported;
  }
  std::cout << version_text() << "\n";
  for (const Check& check : checks) {
    std::cout << mark_of(check.level) << check.name << ": " << check.finding << "\n";
    if (!check.remedy.empty()) std::cout << "          -> " << check.remedy << "\n";
  }
  std::cout << (healthy ? "Overfly can fly on this machine.\n"
                        : "Overfly cannot fly on this machine until the faults are fixed.\n");
  return healthy ? kExitOk : kExitUnsupported;
}

}  // namespace

void add_doctor_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("doctor", "Check this machine and report what is missing");
  const auto runs = std::make_shared<std::string>("runs");
  const auto json = std::make_shared<bool>(false);
  command->add_option("--runs", *runs, "Folder of the runs")->capture_default_str();
  command->add_flag("--json", *json, "Print JSON");
  const auto camera = std::make_shared<DoctorCameraArguments>();
  const auto wanted = std::make_shared<bool>(false);
  CLI::Option* self_test = command->add_flag(
      "--camera",
      *wanted,
      "Instead map images onto the next by depth and pose, and print the residual");
  command->add_option("--scenario", camera->scenario, "With --camera: use this scenario's cameras")
      ->needs(self_test);
  command
      ->add_option(
          "--pairs", camera->pairs, "With --camera: pairs of frames, spread over the flight")
      ->needs(self_test)
      ->capture_default_str();
  command->add_option("--limit-px", camera->limit_px, "With --camera: limit of the median residual")
      ->needs(self_test)
      ->capture_default_str();
  command->callback([runs, json, camera, wanted, &exit_code] {
    camera->json = *json;
    exit_code = *wanted ? check_cameras(*camera) : doctor(*runs, *json);
  });
}

}  // namespace overfly::app
