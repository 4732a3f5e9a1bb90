// What `overfly log info` prints of a flight log.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "flight/logs/flight_log.hpp"

namespace overfly::app {

/// A table of the streams, the sources, the events and the warnings.
[[nodiscard]] std::string log_info_text(const flight::logs::OpenedLog& log);
[[nodiscard]] nlohmann::ordered_json log_info_json(const flight::logs::OpenedLog& log);

}  // namespace overfly::app
