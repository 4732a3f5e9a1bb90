// State, latency and resource use of an estimator during its run.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/motion/estimate.hpp"
#include "server/timing/latency_summary.hpp"

namespace overfly::server {

/// Resources that an estimator has used.
struct EstimatorUse {
  double cpu_s = 0.0;
  double cpu_percent = 0.0;  ///< of one processor, since the estimator was ready
  /// Empty if not known.
  std::optional<double> peak_memory_mb;
  enum class Measured {
    kProcess,       ///< all threads and the memory of its own process
    kOwnAccount,    ///< its threads in this process, and the memory that it reports
    kCallingThread  ///< the thread of this process that calls it
  } measured = Measured::kCallingThread;
};

struct EstimatorStatus {
  std::int64_t answered = 0;
  std::int64_t dropped = 0;            ///< frames that arrived while it was busy
  std::int64_t unanswered = 0;         ///< frames taken, but no pose returned before the timeout
  std::int64_t hashes_compared = 0;    ///< images whose CRC the estimator's side reported
  std::int64_t hash_mismatches = 0;    ///< of those, images that differ from the ones sent
  std::optional<TrackingState> state;  ///< of its last answer; empty before the first
  std::string crash;  ///< why the estimator ended, at the frame where it ended; else empty
  std::optional<LatencySummary> latency;
  std::optional<EstimatorUse> use;
};

/// "STARTING", a tracking state, or "CRASHED".
[[nodiscard]] std::string state_text(const EstimatorStatus& status);

/// {"cpu_s", "cpu_percent", "peak_memory_mb", "measured"}, and the inverse.
[[nodiscard]] nlohmann::json json_from(const EstimatorUse& use);
[[nodiscard]] std::optional<EstimatorUse> estimator_use_from(const nlohmann::json& value);

/// As sent to clients (docs/PROTOCOL.md).
[[nodiscard]] nlohmann::json json_from(const EstimatorStatus& status);

}  // namespace overfly::server
