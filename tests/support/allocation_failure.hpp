// Lets an allocation by operator new fail, in threads that are marked for it.
#pragma once

namespace overfly::testing {

class AllocationFailure {
 public:
  /// Marks the calling thread.
  static void may_fail_here();
  /// The allocation that the marked threads make after `before` others throws std::bad_alloc.
  static void arm(int before);
  /// @return true when one has failed since arm()
  static bool disarm();
};

}  // namespace overfly::testing
