#include "server/timing/cpu_affinity.hpp"

#include <cstddef>
#include <string>

namespace overfly::server {

Status bind_thread(const std::vector<int>& cpus) {
  if (cpus.empty()) return {};
  cpu_set_t set{};
  CPU_ZERO(&set);
  std::string names;
  for (const int cpu : cpus) {
    if (cpu >= 0 && cpu < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(cpu), &set);
    names += (names.empty() ? "" : ", ") + std::to_string(cpu);
  }
  // Pid 0 = the calling thread only.
  if (sched_setaffinity(0, sizeof(set), &set) == 0) return {};
  return Error{ErrorCode::kInvalidArgument,
               "cpus = [" + names + "]: must name a processor of this machine"};
}

AffinityGuard::AffinityGuard() : known_(sched_getaffinity(0, sizeof(before_), &before_) == 0) {}

AffinityGuard::~AffinityGuard() {
  if (known_) sched_setaffinity(0, sizeof(before_), &before_);
}

}  // namespace overfly::server
