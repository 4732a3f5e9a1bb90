// Flight logs of all formats, opened and converted.
#include "flight/logs/truth/log_trajectory.hpp"
#include "tests/fuzz/input_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace overfly;
  const std::filesystem::path file =
      fuzz::InputFolder::of_process().file("flight.log", fuzz::text_of(data, size));
  const auto log = flight::logs::open_log(file);
  if (!log.ok()) return 0;
  for (const auto& stream : log->streams) {
    if (stream.positions > 0) {
      (void)flight::logs::read_log_trajectory(*log, {stream.description.name, {}, {}});
    }
  }
  return 0;
}
