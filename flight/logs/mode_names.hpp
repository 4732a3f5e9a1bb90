// Names of flight modes.
#pragma once

#include <cstdint>
#include <string>

namespace overfly::flight::logs {

/// "mode 10 (AUTO)" of ArduPlane, "mode 10" of other vehicles.
[[nodiscard]] std::string mode_text(std::int64_t mode, bool is_ardu_plane);

}  // namespace overfly::flight::logs
