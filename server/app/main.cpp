// overfly: the command line.
#include <CLI/CLI.hpp>

#include "server/app/version.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Overfly: a virtual flight range for monocular visual odometry"};
  app.set_version_flag("--version", overfly::app::version_text());
  app.require_subcommand(0);
  CLI11_PARSE(app, argc, argv);
  return 0;
}
