// Why an estimator failed, and the flights that show it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/evaluation.hpp"
#include "server/experiments/explain/cause_change.hpp"
#include "server/experiments/explain/critical_part.hpp"

namespace overfly::server::experiments {

/// A flight over the critical part, or over a part that was tried before it was found.
struct Reflight {
  std::string name;  ///< "as it was", "without blur", "with 25 % of blur"
  std::vector<CauseChange> changes;
  std::uint64_t seed = 0;
  CriticalPart part;
  std::filesystem::path folder;  ///< its run folder
  evaluation::Score score;       ///< without the errors of each pose
  bool survived = false;
  std::string error;  ///< why it has no result; then it neither survived nor failed
  double texels_per_pixel_median = 0.0;
  bool texture_limited = false;
  double void_fraction_max = 0.0;

  [[nodiscard]] bool failed() const { return error.empty() && !survived; }
};

/// A cause that was not tried.
struct UntriedCause {
  Cause cause = Cause::kFaults;
  std::string reason;
};

/// How much smaller a cause has to be.
struct CauseMargin {
  Cause cause = Cause::kFaults;
  double survives_share = 0.0;  ///< largest share of it that was survived
  double fails_share = 1.0;     ///< smallest share of it that was not
};

struct Explanation {
  std::string run;  ///< id
  std::string title;
  std::string estimator;
  evaluation::Score score;  ///< of the run
  bool succeeded = false;   ///< there is nothing to explain
  CriticalPart part;        ///< in which the failure was seen again
  bool reproduced = false;  ///< the failure was seen again with nothing changed
  /// The limit of flights ended the search before the failure was seen: not every part was flown.
  bool parts_left_out = false;
  /// With other random numbers too; empty if that was not flown.
  std::optional<bool> reproduced_with_other_seed;

  /// Without one of these the estimator survives.
  std::vector<Cause> necessary;
  /// One of these is enough for the failure: with all other disturbances taken away it still fails.
  std::vector<Cause> sufficient;
  /// Causes that were kept while all other disturbances were taken away: those of them that are not
  /// in `sufficient` were survived.
  std::vector<Cause> sufficiency_tested;
  /// Disturbances of the flight that were not to be changed: with them what is sufficient cannot be
  /// found.
  std::vector<Cause> not_changed;
  /// The necessary causes, if each was tested and none is sufficient: it takes them together.
  std::vector<Cause> together;
  /// Those of the necessary causes without which the estimator survives with other random numbers
  /// too; the others were not flown with them, or have no result.
  std::vector<Cause> confirmed;
  /// Without these the estimator survived, but with other random numbers it fails without them too:
  /// they are not named.
  std::vector<Cause> withdrawn;
  /// No single cause has to go, but without these two the estimator survives; empty or two.
  std::vector<Cause> pair;
  std::optional<CauseMargin> margin;
  bool data_limited = false;  ///< the imagery, not the estimator, is the limit
  std::string data_reason;    ///< why
  std::vector<Reflight> flights;
  std::vector<UntriedCause> untried;
};

}  // namespace overfly::server::experiments
