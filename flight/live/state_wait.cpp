#include "flight/live/state_wait.hpp"

#include "core/cancellable_wait.hpp"
#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/live/live_samples.hpp"

namespace overfly::flight::live {

Status wait_for_states(StateNews& news,
                       const AwaitedSource& source,
                       const std::string& what,
                       const std::function<bool()>& ready,
                       const std::atomic<bool>* cancel) {
  std::unique_lock lock(news.mutex);
  const auto too_far_behind = [&] {
    return Error{ErrorCode::kIo,
                 what + ": the run is more than " + std::to_string(kMaxLiveSamples) +
                     " samples behind " + source.name};
  };
  const Arrivals::Clock::time_point begin = Arrivals::Clock::now();
  while (!ready() && !source.ended()) {
    if (is_cancelled(cancel)) return cancelled(source.name);
    if (source.full()) return too_far_behind();
    if (news.arrivals.silence(begin) >= source.patience) {
      const double patience_s = std::chrono::duration<double>(source.patience).count();
      const std::string missing = source.missing();
      lock.unlock();
      return Error{
          ErrorCode::kIo,
          what + ": " + missing + " within " + number_text(patience_s) + " s: " + source.heard()};
    }
    news.arrived.wait_for(lock, kCancelPeriod);
  }
  // The flight's end, too, lies behind what was not kept.
  if (source.full() && !ready()) return too_far_behind();
  return {};
}

Status check_flight_time(std::int64_t t_ns) {
  constexpr std::int64_t kLongestFlightNs = 366LL * 86400 * kNsPerS;
  if (t_ns >= 0 && t_ns <= kLongestFlightNs) return {};
  return Error{ErrorCode::kInvalidArgument,
               "t_ns = " + std::to_string(t_ns) + ": must be in [0, " +
                   std::to_string(kLongestFlightNs) + "]"};
}

}  // namespace overfly::flight::live
