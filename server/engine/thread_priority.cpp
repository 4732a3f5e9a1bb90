#include "server/engine/thread_priority.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>

namespace overfly::engine {

void lower_thread(ThreadPriority priority) {
  constexpr int kNiceBelowFlights = 5;
  constexpr int kNicest = 19;
  const bool left_over = priority == ThreadPriority::kLeftOver;
  // On Linux a nice value belongs to a thread: its number stands in for the process's.
  (void)setpriority(
      PRIO_PROCESS, static_cast<id_t>(gettid()), left_over ? kNicest : kNiceBelowFlights);
  const sched_param none{};
  if (left_over) (void)sched_setscheduler(0, SCHED_IDLE, &none);
}

void draw_on_the_asking_thread() {
  constexpr int kKeepIfSet = 0;
  (void)setenv("LP_NUM_THREADS", "0", kKeepIfSet);
}

}  // namespace overfly::engine
