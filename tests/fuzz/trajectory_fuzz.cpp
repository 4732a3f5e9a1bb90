// Trajectory files (TUM, KITTI, EuRoC, CSV) and logs of flights (poses, geodetic CSV).
//
// The input is a folder: `poses.txt`, and for KITTI `times.txt`.
#include "core/motion/trajectory_io.hpp"
#include "flight/log_reader.hpp"
#include "tests/fuzz/input_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace overfly;
  const auto& folder =
      fuzz::InputFolder::of_process().fill(fuzz::files_in(fuzz::text_of(data, size)));
  const auto poses = read_trajectory(folder / "poses.txt");
  if (poses && !poses->trajectory.empty()) {
    const auto& stamped = poses->trajectory.poses();
    (void)poses->trajectory.at(stamped[stamped.size() / 2].t_ns);
  }
  const LocalFrame frame{geodetic_from_deg(47.0, 8.0, 500.0)};
  (void)flight::read_log(folder / "poses.txt", frame, true);
  return 0;
}
