// overfly log smooth: a flight log as one smooth trajectory.
#pragma once

namespace CLI {
class App;
}

namespace overfly::app {

/// Adds the command to `overfly log`.
void add_log_smooth(CLI::App& log, int& exit_code);

}  // namespace overfly::app
