// Thread priorities: flights first, then the network, then pictures for viewers.
#pragma once

namespace overfly::server {

enum class ThreadPriority {
  kBelowFlights,  ///< yields to flights, and still gets a fair share of a busy machine
  kLeftOver,      ///< runs only on a processor that is otherwise idle
};

/// Lowers the priority of the calling thread and of the threads that it starts afterwards. This is
/// permanent, since an unprivileged program cannot raise a thread again. Does nothing if the system
/// refuses.
void lower_thread(ThreadPriority priority);

/// Raises the calling thread, and the threads and processes that it starts meanwhile, above the
/// machine's other programs while this object lives. If Linux shares the processors among sessions
/// first (sched(7), "autogroup"), the program's session is raised as well, because a thread's nice
/// value counts only within its session. Needs root or CAP_SYS_NICE; otherwise the priorities stay
/// as they are.
class RaisedThread {
 public:
  RaisedThread();
  ~RaisedThread();
  RaisedThread(const RaisedThread&) = delete;
  RaisedThread& operator=(const RaisedThread&) = delete;

 private:
  int nice_before_ = 0;
  bool raised_ = false;
};

/// Makes Mesa's software renderer draw on the calling thread, so that the drawing has this thread's
/// priority. Call before the first use of OpenGL. LP_NUM_THREADS in the environment is not
/// overwritten.
void draw_on_the_asking_thread();

}  // namespace overfly::server
