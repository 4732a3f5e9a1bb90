// How an estimator fares in its run, besides where it says the camera is.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/estimate.hpp"
#include "server/timing/latency_summary.hpp"

namespace overfly::engine {

/// What an estimator has used of the machine.
struct EstimatorUse {
  double cpu_s = 0.0;
  double cpu_percent = 0.0;  ///< of one processor, since the estimator was ready
  /// Empty where it is not known.
  std::optional<double> peak_memory_mb;
  enum class Measured {
    kProcess,       ///< all threads and the memory of its own process
    kOwnAccount,    ///< its threads in our process, and the memory that it says it holds
    kCallingThread  ///< the thread in our process that calls it
  } measured = Measured::kCallingThread;
};

struct EstimatorStatus {
  std::int64_t answered = 0;
  std::int64_t dropped = 0;            ///< came while it was busy
  std::int64_t unanswered = 0;         ///< taken, and no pose came back in time
  std::int64_t hashes_compared = 0;    ///< images whose CRC the estimator's end told
  std::int64_t hash_mismatches = 0;    ///< of those, other images than were sent
  std::optional<TrackingState> state;  ///< of its last answer; empty before the first
  std::string crash;                   ///< why it is gone; empty while it is there
  std::optional<LatencySummary> latency;
  std::optional<EstimatorUse> use;
};

/// "STARTING", a tracking state, or "CRASHED".
[[nodiscard]] std::string state_text(const EstimatorStatus& status);

/// {"cpu_s", "cpu_percent", "peak_memory_mb", "measured"}, and back.
[[nodiscard]] nlohmann::json json_from(const EstimatorUse& use);
[[nodiscard]] std::optional<EstimatorUse> estimator_use_from(const nlohmann::json& value);

/// As the wire tells it (docs/PROTOCOL.md).
[[nodiscard]] nlohmann::json json_from(const EstimatorStatus& status);

}  // namespace overfly::engine
