#include "renderer/probes/process_cost.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>

namespace overfly::renderer {

namespace {

double clock_ms(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace

double process_cpu_ms() { return clock_ms(CLOCK_PROCESS_CPUTIME_ID); }

double thread_cpu_ms() { return clock_ms(CLOCK_THREAD_CPUTIME_ID); }

double resident_mb() {
  // Linux: the second number of statm, in pages.
  std::ifstream file("/proc/self/statm");
  double size_pages = 0.0, resident_pages = 0.0;
  file >> size_pages >> resident_pages;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto count = static_cast<double>(values.size());
  const auto rank = std::clamp<std::ptrdiff_t>(
      std::llround(std::ceil(share * count - 1e-9)) - 1, 0, std::ssize(values) - 1);
  const auto at = values.begin() + rank;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace overfly::renderer
