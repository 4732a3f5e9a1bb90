// All processes that come of one child, however they have cut themselves loose from it.
#pragma once

#include <chrono>
#include <set>
#include <string>
#include <vector>

namespace overfly::process {

/// Processes whose parent is `pid`, by any of its threads.
[[nodiscard]] std::vector<int> children_of(int pid);

/// Finds the descendants of a child in spite of setsid(2) and double forks: this process is made
/// the subreaper of its descendants (prctl(2)), so that those who lose their parent become its own
/// children, and each inherits an environment variable that tells whose it is. One that loses its
/// parent after it threw its environment away is not found.
class ProcessFamily {
 public:
  ProcessFamily();

  /// "NAME=VALUE" for the environment of the child.
  [[nodiscard]] const std::string& mark() const { return mark_; }
  /// Kills the descendants of the child that are alive now. @param child  not waited for yet
  void kill_members(int child);
  /// Kills, until no descendant is left or the time is over, and takes the exit status of those
  /// that have become ours. @param child  ended, not waited for yet
  void end(int child, std::chrono::milliseconds patience);

 private:
  [[nodiscard]] std::vector<int> living_members(int child) const;
  void reap(int child) const;

  std::string mark_;
  std::set<int> killed_;
};

}  // namespace overfly::process
