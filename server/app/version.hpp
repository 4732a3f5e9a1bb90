// Version text of this build.
#pragma once

#include <string>

namespace overfly::app {

/// "overfly 0.1.0 (commit 1234abc)"
[[nodiscard]] std::string version_text();

}  // namespace overfly::app
