#include "server/experiments/explain/cause_finding.hpp"

namespace overfly::server::experiments {
namespace {

/// The causes that were taken away one at a time.
std::vector<Cause> tried_by_themselves(const Explanation& explanation, bool failed_only) {
  std::vector<Cause> tried;
  for (const Reflight& flight : explanation.flights) {
    if (flight.changes.size() != 1 || !flight.error.empty()) continue;
    if (!failed_only || flight.failed()) tried.push_back(flight.changes.front().cause);
  }
  return tried;
}

}  // namespace

std::vector<CauseFinding> findings_of(const Explanation& explanation) {
  std::vector<Cause> causes;
  for (const std::vector<Cause>& named : {explanation.necessary,
                                          explanation.sufficient,
                                          explanation.together,
                                          explanation.pair,
                                          explanation.sufficiency_tested,
                                          tried_by_themselves(explanation, false)}) {
    for (const Cause cause : named) {
      if (!holds(causes, cause)) causes.push_back(cause);
    }
  }
  const std::vector<Cause> failed = tried_by_themselves(explanation, true);
  std::vector<CauseFinding> findings;
  for (const Cause cause : causes) {
    CauseFinding finding{cause, {}, {}, {}};
    if (holds(explanation.necessary, cause)) {
      finding.necessary = true;
    } else if (holds(failed, cause) || holds(explanation.withdrawn, cause)) {
      finding.necessary = false;
    }
    if (holds(explanation.sufficient, cause)) {
      finding.sufficient = true;
    } else if (holds(explanation.sufficiency_tested, cause)) {
      finding.sufficient = false;
    }
    if (explanation.margin && explanation.margin->cause == cause) {
      finding.margin = explanation.margin;
    }
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace overfly::server::experiments
