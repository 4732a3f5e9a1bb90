// Flight logs that are made to measure how fast they are read.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

#include "core/result.hpp"
#include "flight/logs/flight_log.hpp"

namespace overfly::flight::logs {

/// The formats that write_probe_log() makes.
inline constexpr std::array kProbeFormats = {
    LogFormat::kDataFlash, LogFormat::kTlog, LogFormat::kUlog, LogFormat::kMcap};

/// Writes a log with the messages and rates of a simulated flight: DataFlash at 400 Hz, .tlog with
/// attitudes at 100 Hz, ULog at 200 Hz, MCAP with odometry at 50 Hz and inertial data at 200 Hz
/// (plain CDR, chunks without compression, with checksums). The same bytes at every call.
/// @param format      one of kProbeFormats
/// @param size_bytes  least size; the file is up to 2 MiB larger
/// Errors: kIo.
[[nodiscard]] Status write_probe_log(const std::filesystem::path& file,
                                     LogFormat format,
                                     std::uint64_t size_bytes);

/// Writes such a log and opens it three times; the file is then in the system's cache.
/// @param folder  for the file, which is removed
/// @return the speed of the fastest time [MB/s]
/// Errors: as write_probe_log and open_log.
[[nodiscard]] Result<double> log_opening_mb_per_s(const std::filesystem::path& folder,
                                                  LogFormat format,
                                                  std::uint64_t size_bytes,
                                                  const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::flight::logs
