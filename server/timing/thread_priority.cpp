#include "server/timing/thread_priority.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <mutex>
#include <optional>
#include <string>

namespace overfly::server {
namespace {

constexpr int kNiceOfFlights = -10;
constexpr const char* kAutogroup = "/proc/self/autogroup";

/// The session's nice value; empty if the kernel has no autogroups.
std::optional<int> session_nice() {
  std::ifstream file(kAutogroup);
  std::string group;
  std::string nice;
  int value = 0;
  if (!(file >> group >> nice >> value) || nice != "nice") return std::nullopt;
  return value;
}

bool set_session_nice(int value) {
  std::ofstream file(kAutogroup);
  return static_cast<bool>(file << value << std::flush);
}

/// The session is shared by all flights of the program: the first raises its priority, the last
/// restores it.
class SessionPriority {
 public:
  void raise() {
    const std::lock_guard lock(mutex_);
    if (flights_++ > 0) return;
    nice_before_ = session_nice();
    const bool higher = nice_before_ && *nice_before_ > kNiceOfFlights;
    if (!higher || !set_session_nice(kNiceOfFlights)) nice_before_.reset();
  }

  void restore() {
    const std::lock_guard lock(mutex_);
    if (--flights_ == 0 && nice_before_) (void)set_session_nice(*nice_before_);
  }

 private:
  std::mutex mutex_;
  int flights_ = 0;
  std::optional<int> nice_before_;  ///< set only while it is raised
};

SessionPriority& session_priority() {
  static SessionPriority priority;
  return priority;
}

}  // namespace

void lower_thread(ThreadPriority priority) {
  constexpr int kNiceBelowFlights = 5;
  constexpr int kNicest = 19;
  const bool left_over = priority == ThreadPriority::kLeftOver;
  // On Linux a nice value belongs to a thread; the thread id is used as the process id.
  (void)setpriority(
      PRIO_PROCESS, static_cast<id_t>(gettid()), left_over ? kNicest : kNiceBelowFlights);
  const sched_param none{};
  if (left_over) (void)sched_setscheduler(0, SCHED_IDLE, &none);
}

RaisedThread::RaisedThread() {
  const auto thread = static_cast<id_t>(gettid());
  nice_before_ = getpriority(PRIO_PROCESS, thread);
  raised_ = nice_before_ > kNiceOfFlights && setpriority(PRIO_PROCESS, thread, kNiceOfFlights) == 0;
  session_priority().raise();
}

RaisedThread::~RaisedThread() {
  session_priority().restore();
  if (raised_) (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), nice_before_);
}

void draw_on_the_asking_thread() {
  constexpr int kKeepIfSet = 0;
  (void)setenv("LP_NUM_THREADS", "0", kKeepIfSet);
}

}  // namespace overfly::server
