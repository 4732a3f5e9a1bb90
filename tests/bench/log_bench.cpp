// Speed and memory of reading flight logs: makes a log of each format and opens and converts it.
// Usage: log_bench [MEGABYTES] [FOLDER]     default: 1000, the system's folder for temporary files
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/measure/process_memory.hpp"
#include "core/outside/forward_reader.hpp"
#include "core/time.hpp"
#include "flight/logs/probes/probe_log.hpp"
#include "flight/logs/truth/log_trajectory.hpp"

namespace overfly::flight {
namespace {

template <typename Work>
double elapsed_s(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Reads the file once without parsing, so that it is in the system's cache.
double read_seconds(const std::filesystem::path& file) {
  return elapsed_s([&] {
    auto reader = ForwardReader::open(file);
    while (reader.ok()) {
      const auto bytes = reader->ahead(ForwardReader::kBufferBytes);
      if (!bytes.ok() || bytes->empty()) break;
      reader->skip(bytes->size());
    }
  });
}

int measure_opening(const char* name, const std::filesystem::path& file) {
  const double megabytes = static_cast<double>(std::filesystem::file_size(file)) * 1e-6;
  (void)read_seconds(file);
  const double reading_s = read_seconds(file);
  Result<logs::OpenedLog> log = Error{};
  const double opening_s = elapsed_s([&] { log = logs::open_log(file); });
  if (!log.ok()) return 1;
  std::printf("%-9s %5.0f MB: only reading %5.0f MB/s, opening %5.0f MB/s, %4.0f MB of memory\n",
              name,
              megabytes,
              megabytes / reading_s,
              megabytes / opening_s,
              peak_memory_mb());
  return 0;
}

int measure_converting(const char* name, const std::filesystem::path& file) {
  const double megabytes = static_cast<double>(std::filesystem::file_size(file)) * 1e-6;
  const auto log = logs::open_log(file);
  if (!log.ok()) return 1;
  std::size_t poses = 0;
  const double converting_s = elapsed_s([&] {
    const auto trajectory = logs::read_log_trajectory(*log, {});
    if (trajectory.ok()) poses = trajectory->poses.size();
  });
  std::printf("%-9s converting %5.0f MB/s to %zu poses, %4.0f MB of memory\n",
              name,
              megabytes / converting_s,
              poses,
              peak_memory_mb());
  return poses > 0 ? 0 : 1;
}

/// One minute in the middle of the log, which has an index since it was opened.
int measure_slice(const char* name, const std::filesystem::path& file) {
  const auto whole = logs::open_log(file);
  if (!whole.ok() || !whole->truth) return 1;
  const logs::StreamInfo& source = whole->streams[whole->truth->position];
  const std::int64_t middle_ns = (*source.first_ns + *source.last_ns) / 2;
  const logs::LogSlice slice{middle_ns - 30 * kNsPerS, middle_ns + 30 * kNsPerS};
  std::size_t poses = 0;
  const double slice_s = elapsed_s([&] {
    const auto log = logs::open_log(file, nullptr, {.slice = slice});
    if (!log.ok()) return;
    const auto trajectory = logs::read_log_trajectory(*log, {"", slice.from_ns, slice.to_ns});
    if (trajectory.ok()) poses = trajectory->poses.size();
  });
  std::printf("%-9s converting one minute of %.0f: %.3f s to %zu poses\n",
              name,
              s_from_ns(*source.last_ns - *source.first_ns) / 60.0,
              slice_s,
              poses);
  return poses > 0 ? 0 : 1;
}

/// Runs a measurement in a process of its own, because peak memory never falls.
int apart(int (*measure)(const char*, const std::filesystem::path&),
          const char* name,
          const std::filesystem::path& file) {
  const pid_t child = ::fork();
  if (child == 0) {
    const int failed = measure(name, file);
    std::fflush(stdout);
    ::_exit(failed);
  }
  int status = 1;
  ::waitpid(child, &status, 0);
  return status == 0 ? 0 : 1;
}

}  // namespace
}  // namespace overfly::flight

int main(int count, char** arguments) {
  using namespace overfly::flight;
  const double megabytes = count > 1 ? std::strtod(arguments[1], nullptr) : 1000.0;
  const std::filesystem::path folder =
      count > 2 ? std::filesystem::path(arguments[2]) : std::filesystem::temp_directory_path();
  const auto size_bytes = static_cast<std::uint64_t>(megabytes * 1e6);
  int failures = 0;
  for (const logs::LogFormat format : logs::kProbeFormats) {
    const char* const name = logs::to_string(format);
    const std::filesystem::path file = folder / (std::string("log_bench.") + name);
    if (!logs::write_probe_log(file, format, size_bytes).ok()) ++failures;
    failures += apart(measure_opening, name, file);
    failures += apart(measure_converting, name, file);
    failures += apart(measure_slice, name, file);
    std::filesystem::remove(file);
    std::filesystem::remove(file.string() + ".overfly-index");
  }
  return failures == 0 ? 0 : 1;
}
