// What a hunt found, as JSON, as a table and in sentences (docs/HUNT.md).
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "server/experiments/hunt/hunt.hpp"

namespace overfly::server::experiments {

[[nodiscard]] nlohmann::json json_from(const Hunt& hunt, const HuntResult& result);
/// A table in Markdown: one line for each flight.
[[nodiscard]] std::string markdown_from(const Hunt& hunt, const HuntResult& result);
/// "Failure found with flight 7 of at most 60: ..."
[[nodiscard]] std::string summary_text(const Hunt& hunt, const HuntResult& result);

}  // namespace overfly::server::experiments
