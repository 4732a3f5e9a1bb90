// Flight logs of all formats, opened and converted.
#include "flight/logs/mcap/mcap_parts.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "tests/fuzz/input_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace overfly;
  const std::filesystem::path file =
      fuzz::InputFolder::of_process().file("flight.log", fuzz::text_of(data, size));
  const auto log = flight::logs::open_log(file);
  if (!log.ok()) return 0;
  if (log->format == flight::logs::LogFormat::kMcap && !log->streams.empty()) {
    // The file's own index, which only large files use otherwise.
    auto sliced = *log;
    sliced.slice = {log->streams.front().first_ns, log->streams.front().first_ns};
    const auto parts = flight::logs::mcap_parts_for(file, sliced.slice, nullptr);
    if (parts.ok()) sliced.parts = *parts;
    (void)flight::logs::read_log_trajectory(sliced, {});
  }
  for (const auto& stream : log->streams) {
    if (stream.positions > 0) {
      (void)flight::logs::read_log_trajectory(*log, {stream.description.name, {}, {}});
    }
  }
  return 0;
}
