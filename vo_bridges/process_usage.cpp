#include "vo_bridges/process_usage.hpp"

#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "vo_bridges/proc_files.hpp"

namespace overfly {

namespace {

constexpr std::size_t kProcessLimit = 256;

/// utime, stime, cutime and cstime in seconds: fields 14 to 17 of stat (proc(5)).
std::optional<double> cpu_s_of(int pid) {
  std::optional<std::istringstream> fields = stat_after_name(pid);
  if (!fields) return std::nullopt;
  std::string ignored;
  for (int field = 3; field < 14; ++field) *fields >> ignored;
  double ticks = 0.0;
  for (int field = 14; field <= 17; ++field) {
    double value = 0.0;
    *fields >> value;
    ticks += value;
  }
  if (!*fields) return std::nullopt;
  return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

/// VmHWM; empty for a process that has ended but was not waited for.
std::optional<double> peak_memory_mb_of(int pid) {
  std::ifstream file(proc_folder(pid) / "status");
  for (std::string line; std::getline(file, line);) {
    double kib = 0.0;
    if (line.starts_with("VmHWM:") && std::istringstream(line.substr(6)) >> kib) {
      return kib * 1024.0 / 1e6;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<ResourceUse> usage_of(int pid) {
  std::vector<int> pids = {pid};
  std::optional<ResourceUse> all;
  for (std::size_t i = 0; i < pids.size(); ++i) {
    const std::optional<double> cpu_s = cpu_s_of(pids[i]);
    const std::optional<double> memory_mb = peak_memory_mb_of(pids[i]);
    if (i == 0 && (!cpu_s || !memory_mb)) return std::nullopt;
    if (!all) all.emplace();
    all->cpu_s += cpu_s.value_or(0.0);
    all->peak_memory_mb += memory_mb.value_or(0.0);
    for (const int child : children_of(pids[i])) {
      if (pids.size() < kProcessLimit) pids.push_back(child);
    }
  }
  return all;
}

}  // namespace overfly
