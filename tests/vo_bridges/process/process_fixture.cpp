#include "tests/vo_bridges/process/process_fixture.hpp"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include "core/time.hpp"
#include "tests/support/support.hpp"

namespace overfly::testing {

ProcessEstimatorOptions python_estimator(const std::string& methods,
                                         const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "estimator.py";
  write_text(file,
             "import sys\n"
             "sys.path.insert(0, sys.argv[1])\n"
             "import overfly_vo\n"
             "class Scripted(overfly_vo.Estimator):\n" +
                 methods + "overfly_vo.run(Scripted())\n");
  ProcessEstimatorOptions options = scripted("");
  options.command = {"python3", "-B", file.string(), source_file("vo_bridges/client").string()};
  return options;
}

Image ground_image(int width_px, int height_px, double moved_x_px, double moved_y_px) {
  Image image(width_px, height_px, 1);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const double u = x + moved_x_px;
      const double v = y + moved_y_px;
      const double value = 128.0 + 30.0 * std::sin(0.11 * u + 0.05 * v) +
                           25.0 * std::sin(0.13 * v - 0.04 * u + 1.0) +
                           20.0 * std::sin(0.071 * u + 2.0) * std::sin(0.083 * v) +
                           15.0 * std::sin(0.19 * u) + 15.0 * std::sin(0.17 * v + 0.5);
      image.at(x, y) = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
    }
  }
  return image;
}

std::vector<VoFrame> ground_frames(
    int count, double step_x_px, double step_y_px, int width_px, int height_px) {
  std::vector<VoFrame> frames;
  for (int i = 0; i < count; ++i) {
    VoFrame frame;
    frame.index = i;
    frame.t_ns = frame_time_ns(i, FrameRate{});
    frame.image = std::make_shared<const Image>(
        ground_image(width_px, height_px, i * step_x_px, i * step_y_px));
    frame.intrinsics =
        PinholeCamera::from_fov(width_px, height_px, 1.48, FovAxis::kHorizontal).value();
    frames.push_back(std::move(frame));
  }
  return frames;
}

bool alive(int pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  if (!std::getline(file, text)) return false;
  const std::size_t name_end = text.rfind(')');
  return name_end != std::string::npos && text.size() > name_end + 2 && text[name_end + 2] != 'Z';
}

int first_cpu() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  EXPECT_EQ(::sched_getaffinity(0, sizeof(allowed), &allowed), 0);
  int cpu = 0;
  while (cpu + 1 < CPU_SETSIZE && !CPU_ISSET(cpu, &allowed)) ++cpu;
  return cpu;
}

bool gone_soon(int pid) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (alive(pid)) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

}  // namespace overfly::testing
