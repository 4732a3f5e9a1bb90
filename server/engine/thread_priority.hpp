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

/// Has Mesa's software renderer draw on the thread that asks for it, so that this thread's priority
/// is the drawing's. Before the first use of OpenGL; LP_NUM_THREADS in the environment stays.
void draw_on_the_asking_thread();

}  // namespace overfly::engine
