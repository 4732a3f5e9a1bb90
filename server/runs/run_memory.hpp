// How much memory a scenario's flight needs, and whether there is enough.
#pragma once

#include <cstdint>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Memory of one flight, or the total of several.
struct RunMemory {
  /// Images in the buffers of cameras and estimators; determined by the scenario.
  std::uint64_t images_bytes = 0;
  /// Maximum size of the caches of terrain and textures.
  std::uint64_t caches_bytes = 0;

  RunMemory& operator+=(const RunMemory& other);
};

/// Computed from the camera sizes and the number of image buffers (docs/PERFORMANCE.md, "Memory").
[[nodiscard]] RunMemory memory_of(const Scenario& scenario);

/// Memory available to this process: the machine's memory, or the limit of its control group
/// [bytes].
[[nodiscard]] std::uint64_t machine_memory_bytes();

/// The memory that flights may use together.
class MemoryBudget {
 public:
  /// @param limit_bytes  of the process
  /// @param views  whether pictures are also drawn for viewers
  MemoryBudget(std::uint64_t limit_bytes, bool views) : limit_bytes_(limit_bytes), views_(views) {}

  /// Four fifths of the machine's memory.
  [[nodiscard]] static MemoryBudget of_machine(bool views);

  /// Memory of the smallest machine, or control group, whose budget holds this total [bytes].
  [[nodiscard]] static std::uint64_t least_machine_bytes(const RunMemory& together);

  /// Whether flights that need this total fit.
  [[nodiscard]] bool holds(const RunMemory& together) const;
  /// Whether a flight fits if it is the only one. Errors: kUnsupported "cameras = ...: must ...".
  [[nodiscard]] Status check(const Scenario& scenario) const;

 private:
  /// Memory left for images next to the caches, which take at most half of the limit.
  [[nodiscard]] std::uint64_t for_images_bytes(std::uint64_t caches_bytes) const;

  std::uint64_t limit_bytes_;
  bool views_;
};

}  // namespace overfly::server
