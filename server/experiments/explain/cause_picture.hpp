// Which cause is necessary, which is sufficient, and what margin was left, as a picture.
#pragma once

#include <string>
#include <vector>

#include "server/experiments/explain/cause_finding.hpp"

namespace overfly::server::experiments {

/// Inline SVG: a row for each finding, with marks that differ in form and word as well as in
/// colour. The bar of a margin goes from nothing of the cause to all of it.
[[nodiscard]] std::string cause_picture(const std::vector<CauseFinding>& findings);

}  // namespace overfly::server::experiments
