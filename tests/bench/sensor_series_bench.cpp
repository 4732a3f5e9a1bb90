// Curves of an hour of a run's sensor: a stretch of 10 s near its end, without and with the index
// that an earlier request has left, and the whole hour. Prints seconds and bytes read.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "core/time.hpp"
#include "server/record/rows/sensor_files.hpp"
#include "server/record/rows/sensor_series.hpp"
#include "tests/support/support.hpp"

namespace {

using namespace overfly;

void write_hour(const std::filesystem::path& folder) {
  constexpr std::int64_t kStepNs = kNsPerS / 200;
  server::SensorFilesWriter writer(folder);
  for (std::int64_t minute = 0; minute < 60; ++minute) {
    SensorSamples samples;
    for (std::int64_t i = minute * 12'000; i < (minute + 1) * 12'000; ++i) {
      const double t_s = s_from_ns(i * kStepNs);
      samples.imu.push_back(
          {i * kStepNs,
           {std::sin(t_s), 0.1 * std::cos(3.0 * t_s), -9.81 + 0.01 * std::sin(t_s)},
           {0.1 * std::sin(2.0 * t_s), 0.02 * std::cos(t_s), 0.1},
           kStepNs});
    }
    if (!writer.add(samples)) std::abort();
  }
}

void print_fastest(const char* what,
                   const std::filesystem::path& folder,
                   const server::SensorSeriesRequest& request,
                   server::SensorIndex* kept) {
  double fastest_s = 1e9;
  std::uint64_t bytes = 0;
  for (int i = 0; i < 5; ++i) {
    server::SensorIndex fresh;
    const auto begin = std::chrono::steady_clock::now();
    const auto series =
        server::read_sensor_series(folder, request, kept != nullptr ? *kept : fresh);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    if (!series) std::abort();
    fastest_s = std::min(fastest_s, passed.count());
    bytes = series->bytes_read;
  }
  std::printf(
      "%-28s %8.4f s %12llu bytes\n", what, fastest_s, static_cast<unsigned long long>(bytes));
}

}  // namespace

int main() {
  const testing::TemporaryFolder folder;
  write_hour(folder.path());
  server::SensorIndex index;
  server::SensorSeriesRequest late;
  late.from_ns = 3500 * kNsPerS;
  late.to_ns = 3510 * kNsPerS;
  print_fastest("10 s, first request", folder.path(), late, nullptr);
  print_fastest("10 s, later requests", folder.path(), late, &index);
  print_fastest("whole hour", folder.path(), {}, &index);
  return 0;
}
