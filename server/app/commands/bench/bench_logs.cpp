#include "server/app/commands/bench/bench_logs.hpp"

#include <string>

#include "flight/logs/probes/probe_log.hpp"
#include "server/app/commands/bench/bench_folder.hpp"
#include "server/app/stop_signal.hpp"

namespace overfly::app {

Result<nlohmann::json> bench_logs() {
  constexpr std::uint64_t kLogBytes = 32'000'000;
  const Result<BenchFolder> folder = BenchFolder::create();
  if (!folder) return folder.error();
  nlohmann::json result = nlohmann::json::object();
  for (const flight::logs::LogFormat format : flight::logs::kProbeFormats) {
    const Result<double> mb_per_s = flight::logs::log_opening_mb_per_s(
        folder->path(), format, kLogBytes, &catch_stop_signals());
    if (!mb_per_s) return mb_per_s.error();
    const bool ulog = format == flight::logs::LogFormat::kUlog;
    result[std::string(ulog ? "ulg" : to_string(format)) + "_mb_per_s"] = *mb_per_s;
  }
  return result;
}

}  // namespace overfly::app
