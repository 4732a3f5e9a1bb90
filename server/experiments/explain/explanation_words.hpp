// An explanation in sentences.
#pragma once

#include <string>
#include <vector>

#include "server/experiments/explain/explanation.hpp"

namespace overfly::server::experiments {

/// The answer first, then how it was found and what limits it. One sentence or two each.
[[nodiscard]] std::vector<std::string> sentences_of(const Explanation& explanation);

/// "LOST at 12.3 s"
[[nodiscard]] std::string outcome_words(const evaluation::Score& score);

/// "survives", "fails: LOST 3.2 s after its start", "no result: ..."
[[nodiscard]] std::string result_words(const Reflight& flight);

/// "survives 12.5 % of it and fails at 25 %"
[[nodiscard]] std::string margin_words(const CauseMargin& margin);

}  // namespace overfly::server::experiments
