// The unit in which processors move memory, and requests for it.
#pragma once

#include <cstddef>

namespace overfly::renderer::raycast {

/// Data of different threads is placed on different cache lines.
inline constexpr std::size_t kCacheLineBytes = 64;

/// As __builtin_prefetch. GCC 12 removes calls of functions that use nothing but that.
inline void request_cache_line(const char* at) {
#if defined(__x86_64__)
  asm volatile("prefetcht0 %0" : : "m"(*at));
#else
  __builtin_prefetch(at);
#endif
}

}  // namespace overfly::renderer::raycast
