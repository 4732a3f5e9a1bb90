#include "core/measure/process_memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace overfly {

double resident_memory_mb() {
  // Linux: the second number of statm, in pages.
  std::ifstream file("/proc/self/statm");
  double size_pages = 0.0, resident_pages = 0.0;
  file >> size_pages >> resident_pages;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

double peak_memory_mb() {
  rusage use{};
  if (getrusage(RUSAGE_SELF, &use) != 0) return 0.0;
  constexpr double kMbPerKib = 1024e-6;
  return kMbPerKib * static_cast<double>(use.ru_maxrss);
}

}  // namespace overfly
