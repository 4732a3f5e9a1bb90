// What a flight log contains, as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "flight/logs/flight_log.hpp"

namespace overfly::server {

/// A table of the streams, the sources, the events and the warnings.
[[nodiscard]] std::string log_info_text(const flight::logs::OpenedLog& log);
[[nodiscard]] nlohmann::ordered_json log_info_json(const flight::logs::OpenedLog& log);

}  // namespace overfly::server
