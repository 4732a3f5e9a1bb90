// Waits of a run for the states of a live source.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>

#include "core/result.hpp"
#include "flight/live/arrivals.hpp"

namespace overfly::flight::live {

/// The lock of a source's states, and how those who wait learn of new ones.
struct StateNews {
  mutable std::mutex mutex;
  std::condition_variable arrived;  ///< to be notified after each message
  Arrivals arrivals;
};

/// What a wait is told by its source. The functions are called under the lock, but for `heard`.
struct AwaitedSource {
  std::string name;                      ///< "the vehicle"
  std::chrono::milliseconds patience{};  ///< without a new state
  std::function<bool()> ended;           ///< the flight has ended: no more states will come
  std::function<bool()> full;            ///< states were not kept, because too many wait
  std::function<std::string()> missing;  ///< what has not come: "no new state"
  std::function<std::string()> heard;    ///< what came last, or whether anybody sends
};

/// Waits until `ready` holds or the flight has ended.
/// @param what    for messages: "the vehicle's state at 1.000 s"
/// @param cancel  may be null
/// Errors: kIo after the patience, with what is missing and what was heard, and if the run is too
/// far behind its source; kCancelled.
[[nodiscard]] Status wait_for_states(StateNews& news,
                                     const AwaitedSource& source,
                                     const std::string& what,
                                     const std::function<bool()>& ready,
                                     const std::atomic<bool>* cancel);

/// Whether a state may be asked for: a year at most, so that sums with a source's clock cannot
/// overflow. Errors: kInvalidArgument.
[[nodiscard]] Status check_flight_time(std::int64_t t_ns);

}  // namespace overfly::flight::live
