// How threads share the processors: flights first, then the network, then pictures for viewers.
#pragma once

namespace overfly::engine {

enum class ThreadPriority {
  kBelowFlights,  ///< gives way, and still gets a fair share of a busy machine
  kLeftOver,      ///< runs only on a processor that nobody else wants
};

/// Lowers the calling thread and those that it starts from then on; for good, since a program
/// without privileges cannot raise a thread again. Does nothing where the system refuses.
void lower_thread(ThreadPriority priority);

/// Raises the calling thread, and the threads and processes that it starts meanwhile, above the
/// machine's other programs while this object lives. Where Linux shares the processors among
/// sessions first (sched(7), "autogroup"), the program's session is raised as well: a thread's nice
/// value counts only within its session there. Needs root or CAP_SYS_NICE; without it all keep the
/// priority that they have.
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

/// Has Mesa's software renderer draw on the thread that asks for it, so that this thread's priority
/// is the drawing's. Before the first use of OpenGL; LP_NUM_THREADS in the environment stays.
void draw_on_the_asking_thread();

}  // namespace overfly::engine
