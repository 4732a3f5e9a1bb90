// Finds and ends all descendants of a child process, even detached ones.
#pragma once

#include <chrono>
#include <set>
#include <string>
#include <vector>

namespace overfly::process {

/// Finds the descendants of a child despite setsid(2) and double forks. This process becomes the
/// subreaper of its descendants (prctl(2)), so that orphans become its own children. Each inherits
/// an environment variable that identifies its child. An orphan that has cleared its environment is
/// not found.
class ProcessFamily {
 public:
  ProcessFamily();

  /// "NAME=VALUE" for the child's environment.
  [[nodiscard]] const std::string& mark() const { return mark_; }
  /// Kills the descendants that are alive now. @param child  not yet waited for
  void kill_members(int child);
  /// Kills until no descendant is left or `patience` has passed, and collects the exit status of
  /// those that became children of this process. @param child  ended, not yet waited for
  void end(int child, std::chrono::milliseconds patience);

 private:
  [[nodiscard]] std::vector<int> living_members(int child) const;
  void reap(int child) const;

  std::string mark_;
  std::set<int> killed_;
};

}  // namespace overfly::process
