// The envelope of an estimator: how far along one axis of a sweep it survives, for all other
// values.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/fly_sweep.hpp"

namespace overfly::server::experiments {

struct EnvelopeOptions {
  SweepOptions flights;
  std::string axis;       ///< name of the axis along which the border is sought
  std::string estimator;  ///< empty = the first one
  /// Called with the number of cells flown so far.
  std::function<void(std::size_t)> progress;
};

struct EnvelopeLine {
  nlohmann::json at;                       ///< other axis -> value
  std::optional<nlohmann::json> survives;  ///< last value that survives; empty = none does
  std::optional<nlohmann::json> fails;     ///< next value, which fails; empty = none does
  bool irregular = false;                  ///< survival does not end once
};

struct Envelope {
  std::string axis, label, unit;
  std::string estimator;
  std::vector<EnvelopeLine> lines;
  std::size_t cells_needed = 0;
  std::size_t cells = 0;  ///< of the sweep
};

/// Finds the border by bisection, as find_borders. Flies into the folder of the sweep: what is
/// there is not flown again, and `overfly sweep` can fill the rest. A cell survives if at least
/// half of its flights have the outcome COMPLETED. Errors: as fly_sweep; kInvalidArgument for an
/// axis that the sweep lacks or that has less than two values, an unknown estimator, a Latin
/// hypercube and skipped cells; kCancelled; kInternal for a cell whose flights failed.
[[nodiscard]] Result<Envelope> find_envelope(const Sweep& sweep, const EnvelopeOptions& options);

/// A table in Markdown.
[[nodiscard]] std::string markdown_from(const Sweep& sweep, const Envelope& envelope);
[[nodiscard]] nlohmann::json json_from(const Envelope& envelope);

}  // namespace overfly::server::experiments
