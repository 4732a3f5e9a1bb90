#include "flight/live/live_doubts.hpp"

#include "core/text/number_text.hpp"
#include "flight/live/live_motion.hpp"

namespace overfly::flight::live {

std::vector<std::string> texts_of(const LiveDoubts& doubts, std::int64_t start_ns) {
  std::vector<std::string> texts;
  if (doubts.jumps > 0) {
    texts.push_back(counted(doubts.jumps, "jump") + " of the vehicle's positions, the largest by " +
                    std::to_string(static_cast<std::int64_t>(doubts.largest_jump_m)) + " m at " +
                    seconds_shown(doubts.largest_jump_ns - start_ns) +
                    ": steps of more than 20 m and 150 m/s");
  }
  if (doubts.backward > 0) {
    texts.push_back(counted(doubts.backward, "sample") +
                    " of the vehicle left out: earlier than the one before, the furthest by " +
                    seconds_shown(doubts.furthest_back_ns) + " at " +
                    seconds_shown(doubts.furthest_back_at_ns - start_ns));
  }
  return texts;
}

}  // namespace overfly::flight::live
