// A few threads that share the work on one picture.
#pragma once

#include <functional>
#include <memory>

namespace overfly::renderer {

/// Threads that wait between pictures. The caller's thread works too, so a pool of one starts no
/// threads.
class WorkerPool {
 public:
  /// @param threads  that work at once; 0 = one per core, at most 8
  explicit WorkerPool(int threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Calls job(i) once for every i in [0, jobs), in any order and on any of the threads; returns
  /// when all are done.
  /// If a job throws, jobs that have not begun are omitted, and the first exception is thrown on
  /// when the others are done.
  void run(int jobs, const std::function<void(int)>& job);
  [[nodiscard]] int threads() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace overfly::renderer
