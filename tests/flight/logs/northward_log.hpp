// A small flight log for tests of commands and requests.
#pragma once

#include <cstdint>
#include <string>

#include "tests/flight/logs/log_bytes.hpp"

namespace overfly::testing {

/// A DataFlash log of 2 s at 25 Hz from 1 s on: to the north at 25 m/s, in AUTO, rolled by 10 deg.
inline std::string northward_log() {
  using namespace flight::testing;
  Bytes bytes = format_record(0x80, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
  append(bytes, format_record(2, 29, "SIM", "QLLfccc", "TimeUS,Lat,Lng,Alt,Roll,Pitch,Yaw"));
  append(bytes, format_record(3, 14, "MODE", "QMBB", "TimeUS,Mode,ModeNum,Rsn"));
  Bytes mode = record_header(3);
  put(mode, std::uint64_t{1'000'000});
  for (const int value : {10, 10, 1}) mode.push_back(static_cast<std::uint8_t>(value));
  append(bytes, mode);
  for (int i = 0; i < 50; ++i) {
    Bytes record = record_header(2);
    put(record, static_cast<std::uint64_t>(1'000'000 + 40'000 * i));
    put(record, 470000000 + 90 * i);
    put(record, std::int32_t{80000000});
    put(record, 500.0F);
    for (const std::int16_t angle : {1000, 0, 0}) put(record, angle);
    append(bytes, record);
  }
  return {bytes.begin(), bytes.end()};
}

}  // namespace overfly::testing
