// SIGINT and SIGTERM as a flag and as an event to wait for.
#pragma once

#include <atomic>

namespace overfly::app {

/// Makes the two signals set the flag instead of ending the process; a second signal ends it at
/// once. Call before threads are started.
[[nodiscard]] const std::atomic<bool>& catch_stop_signals();

/// Waits for one of the signals. @pre catch_stop_signals() was called
void wait_for_stop_signal();

}  // namespace overfly::app
