// overfly: the command line.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>

#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/version.hpp"

int main(int argc, char** argv) {
  using namespace overfly::app;
  // A parent that ignores it hands that on, and then no child can be waited for.
  std::signal(SIGCHLD, SIG_DFL);
  CLI::App app{"Overfly: a virtual flight range for monocular visual odometry", "overfly"};
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  int exit_code = kExitOk;
  add_run_command(app, exit_code);
  add_serve_command(app, exit_code);
  add_track_command(app, exit_code);
  add_evaluate_command(app, exit_code);
  add_sweep_command(app, exit_code);
  add_envelope_command(app, exit_code);
  add_compare_command(app, exit_code);
  add_table_command(app, exit_code);
  add_explain_command(app, exit_code);
  add_hunt_command(app, exit_code);
  add_predict_command(app, exit_code);
  add_report_command(app, exit_code);
  add_agreement_command(app, exit_code);
  add_render_command(app, exit_code);
  add_calibrate_command(app, exit_code);
  add_world_command(app, exit_code);
  add_scenario_command(app, exit_code);
  add_export_command(app, exit_code);
  add_log_command(app, exit_code);
  add_vehicle_command(app, exit_code);
  add_play_command(app, exit_code);
  add_bench_command(app, exit_code);
  add_doctor_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  } catch (const std::exception& failure) {
    // Exceptions that no command handles: a removed working folder, out of memory.
    return report({overfly::ErrorCode::kInternal, failure.what()});
  }
  std::cout.flush();
  if (exit_code == kExitOk && (!std::cout || std::fflush(stdout) != 0)) {
    return report({overfly::ErrorCode::kIo, "the standard output cannot be written"});
  }
  return exit_code;
}
