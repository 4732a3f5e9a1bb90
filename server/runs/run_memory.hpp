// How much memory a scenario's flight needs, and whether there is enough of it.
#pragma once

#include <cstdint>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::engine {

/// Of one flight, or of several together.
struct RunMemory {
  /// Images in the cameras' and estimators' buffers: what the scenario decides.
  std::uint64_t images_bytes = 0;
  /// What caches of ground and textures grow to at the most.
  std::uint64_t caches_bytes = 0;

  RunMemory& operator+=(const RunMemory& other);
};

/// From the sizes of cameras, and what holds their images (docs/PERFORMANCE.md, "Memory").
[[nodiscard]] RunMemory memory_of(const Scenario& scenario);

/// What this process may use: the machine's memory, or its control group's limit [bytes].
[[nodiscard]] std::uint64_t machine_memory_bytes();

/// Memory that flights may use together.
class MemoryBudget {
 public:
  /// @param limit_bytes  of the process
  /// @param views        pictures are drawn for viewers, too
  MemoryBudget(std::uint64_t limit_bytes, bool views) : limit_bytes_(limit_bytes), views_(views) {}

  /// Four fifths of the machine's memory.
  [[nodiscard]] static MemoryBudget of_machine(bool views);

  /// Whether flights that need so much together fit.
  [[nodiscard]] bool holds(const RunMemory& together) const;
  /// Whether a flight fits alone. Errors: kUnsupported "cameras = ...: must ...".
  [[nodiscard]] Status check(const Scenario& scenario) const;

 private:
  /// What is left for images beside the caches: those have at most half of the limit.
  [[nodiscard]] std::uint64_t for_images_bytes(std::uint64_t caches_bytes) const;

  std::uint64_t limit_bytes_;
  bool views_;
};

}  // namespace overfly::engine
