// overfly bench: the speed of reading flight logs.
#pragma once

#include <nlohmann/json.hpp>

#include "core/result.hpp"

namespace overfly::app {

/// Opens generated logs of 32 MB in a temporary folder.
/// @return dataflash_mb_per_s, tlog_mb_per_s, ulg_mb_per_s, mcap_mb_per_s
[[nodiscard]] Result<nlohmann::json> bench_logs();

}  // namespace overfly::app
