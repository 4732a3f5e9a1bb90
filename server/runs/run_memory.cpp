#include "server/runs/run_memory.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "server/estimators/estimator_factory.hpp"
#include "server/run/frames_ahead.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMib = std::uint64_t{1} << 20U;

/// Maximum size of the caches of one renderer (docs/PERFORMANCE.md, "Paging"): tiles, heights,
/// elevation blocks and terrain patches; with OpenGL the same number of tiles again as textures.
constexpr std::uint64_t kRaycastCachesBytes = 900 * kMib;
constexpr std::uint64_t kEglCachesBytes = 1250 * kMib;
/// For a second renderer over a world that is already open: tiles, textures, patches.
constexpr std::uint64_t kViewCachesBytes = 600 * kMib;
/// Fraction of the machine's memory that is the default limit.
constexpr double kMachineShare = 0.8;

/// Sizes of one camera's images [bytes].
struct CameraSizes {
  std::uint64_t pixels = 0;
  std::uint64_t image = 0;     ///< 8 bit
  std::uint64_t image16 = 0;   ///< for a sensor deeper than 8 bit
  std::uint64_t radiance = 0;  ///< for a camera with a sensor
};

CameraSizes sizes_of(const CameraSpec& camera) {
  const PinholeCamera& pinhole = camera.model.pinhole();
  CameraSizes sizes;
  sizes.pixels =
      static_cast<std::uint64_t>(pinhole.width_px) * static_cast<std::uint64_t>(pinhole.height_px);
  sizes.image = sizes.pixels * (camera.rgb ? 3 : 1);
  if (camera.sensor.enabled) sizes.radiance = 4 * sizes.image;
  if (camera.sensor.enabled && camera.sensor.bits > 8) sizes.image16 = 2 * sizes.image;
  return sizes;
}

bool may_freeze(const Scenario& scenario) {
  return std::any_of(scenario.faults.begin(), scenario.faults.end(), [](const FaultSpec& fault) {
    return fault.kind == FaultKind::kFrozenFrame;
  });
}

/// Held between frames: the image in progress, the previous one for viewers, and the fields of the
/// sensor's fixed patterns.
std::uint64_t held_bytes(const Scenario& scenario, const CameraSpec& camera) {
  const CameraSizes sizes = sizes_of(camera);
  std::uint64_t bytes = 2 * sizes.image + sizes.image16;
  if (may_freeze(scenario)) bytes += sizes.image + sizes.image16;
  if (camera.sensor.enabled) {
    bytes += (camera.sensor.prnu > 0.0 ? 4 : 0) * sizes.image;
    bytes += (camera.sensor.dsnu_e > 0.0 ? 4 : 0) * sizes.image;
  }
  return bytes;
}

/// Held only while one camera's image is made: the image, the radiance before the sensor, the
/// defocused radiance, the grey copy of a colour image, the encoded file.
std::uint64_t passing_bytes(const Scenario& scenario, const CameraSpec& camera) {
  const CameraSizes sizes = sizes_of(camera);
  std::uint64_t bytes = sizes.image + sizes.radiance;
  if (camera.sensor.enabled && camera.sensor.defocus_sigma_px > 0.0) bytes += sizes.radiance;
  if (camera.rgb) bytes += sizes.pixels;
  if (scenario.record_frames) bytes += sizes.image + sizes.image16;
  return bytes;
}

/// OpenGL's render target, shared by cameras of the same size: colour and depth, and four channels
/// for read-back.
std::uint64_t target_bytes(const CameraSpec& camera) {
  const std::uint64_t sample = camera.sensor.enabled ? 4 : 1;
  const std::uint64_t colour = camera.rgb ? 4 * sample : sample;
  const std::uint64_t back = camera.rgb ? colour : 0;
  return sizes_of(camera).pixels * (colour + back + 4);
}

/// What OpenGL needs to compose an image of several samples or through a lens: the sum of the
/// samples and, for a lens, the ray of each sample.
std::uint64_t composing_bytes(const CameraSpec& camera) {
  const bool has_lens = !camera.model.distortion().none();
  const bool many_samples = camera.quality != renderer::RenderQuality::kTrilinear;
  if (!has_lens && !many_samples) return 0;
  constexpr std::uint64_t kMostSamples = 4;  // of RenderQuality::kReference
  const CameraSizes sizes = sizes_of(camera);
  const std::uint64_t rays = (many_samples ? kMostSamples : 1) * sizes.pixels;
  return sizeof(float) * sizes.image + (has_lens ? 2 * sizeof(float) * rays : 0);
}

/// Copies of the grey image: one waiting and one in progress, a pyramid and the debug image; and
/// what a native estimator keeps for itself (an outside process has its own memory).
std::uint64_t estimator_bytes(const Scenario& scenario, const EstimatorSpec& estimator) {
  constexpr double kCopies = 8.0;
  const CameraSpec& camera = scenario.cameras[estimator.camera];
  const auto pixels = static_cast<double>(sizes_of(camera).pixels);
  return static_cast<std::uint64_t>((kCopies + own_bytes_per_px(estimator)) * pixels);
}

std::string bytes_text(std::uint64_t bytes) {
  return std::to_string((bytes + kMib - 1) / kMib) + " MiB";
}

std::string cameras_text(const Scenario& scenario) {
  const auto largest = std::max_element(scenario.cameras.begin(),
                                        scenario.cameras.end(),
                                        [](const CameraSpec& a, const CameraSpec& b) {
                                          return sizes_of(a).image < sizes_of(b).image;
                                        });
  const PinholeCamera& pinhole = largest->model.pinhole();
  return "cameras = " + std::to_string(scenario.cameras.size()) + " of up to " +
         std::to_string(pinhole.width_px) + " x " + std::to_string(pinhole.height_px) + " px" +
         (largest->rgb ? " in colour" : "");
}

/// Reads a file with a single number; empty for "max" and if it cannot be read.
std::optional<std::uint64_t> number_in(const fs::path& file) {
  std::ifstream in(file);
  std::uint64_t number = 0;
  return in >> number ? std::optional<std::uint64_t>(number) : std::nullopt;
}

/// The lowest limit of the control groups from this process's up to the root.
std::uint64_t control_group_bytes() {
  std::uint64_t limit = std::numeric_limits<std::uint64_t>::max();
  const fs::path root = "/sys/fs/cgroup";
  if (const auto bytes = number_in(root / "memory/memory.limit_in_bytes")) limit = *bytes;
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    if (!line.starts_with("0::/")) continue;
    for (fs::path group = line.substr(4);; group = group.parent_path()) {
      if (const auto bytes = number_in(root / group / "memory.max"))
        limit = std::min(limit, *bytes);
      if (group.empty()) break;
    }
  }
  return limit;
}

}  // namespace

RunMemory& RunMemory::operator+=(const RunMemory& other) {
  images_bytes += other.images_bytes;
  caches_bytes += other.caches_bytes;
  return *this;
}

RunMemory memory_of(const Scenario& scenario) {
  RunMemory memory;
  const bool raycast = scenario.renderer.camera == "raycast";
  std::uint64_t most_passing = 0;
  std::set<std::tuple<int, int, bool, bool>> targets;
  for (const CameraSpec& camera : scenario.cameras) {
    memory.images_bytes += held_bytes(scenario, camera);
    most_passing = std::max(
        most_passing, passing_bytes(scenario, camera) + (raycast ? 0 : composing_bytes(camera)));
    const PinholeCamera& pinhole = camera.model.pinhole();
    const bool new_target =
        targets.emplace(pinhole.width_px, pinhole.height_px, camera.rgb, camera.sensor.enabled)
            .second;
    if (new_target && !raycast) memory.images_bytes += target_bytes(camera);
  }
  // Once in the run, and once when an image is rendered again for a viewer.
  memory.images_bytes += 2 * most_passing;
  for (const EstimatorSpec& estimator : scenario.estimators) {
    memory.images_bytes += estimator_bytes(scenario, estimator);
  }
  memory.images_bytes += lockstep_frames_ahead(scenario) * frame_bytes(scenario);
  memory.caches_bytes = raycast ? kRaycastCachesBytes : kEglCachesBytes;
  return memory;
}

std::uint64_t machine_memory_bytes() {
  std::uint64_t bytes = control_group_bytes();
  std::ifstream in("/proc/meminfo");
  std::string name;
  std::uint64_t kib = 0;
  if (in >> name >> kib && name == "MemTotal:") bytes = std::min(bytes, kib * 1024);
  return bytes;
}

MemoryBudget MemoryBudget::of_machine(bool views) {
  return {static_cast<std::uint64_t>(kMachineShare * static_cast<double>(machine_memory_bytes())),
          views};
}

std::uint64_t MemoryBudget::least_machine_bytes(const RunMemory& together) {
  // The inverse of for_images_bytes(): the caches give way down to half of the limit.
  const std::uint64_t limit_bytes =
      std::min(together.images_bytes + together.caches_bytes, 2 * together.images_bytes);
  return static_cast<std::uint64_t>(std::ceil(static_cast<double>(limit_bytes) / kMachineShare)) +
         1;
}

std::uint64_t MemoryBudget::for_images_bytes(std::uint64_t caches_bytes) const {
  const std::uint64_t caches = caches_bytes + (views_ ? kViewCachesBytes : 0);
  return limit_bytes_ - std::min(caches, limit_bytes_ / 2);
}

bool MemoryBudget::holds(const RunMemory& together) const {
  return together.images_bytes <= for_images_bytes(together.caches_bytes);
}

Status MemoryBudget::check(const Scenario& scenario) const {
  const RunMemory memory = memory_of(scenario);
  if (holds(memory)) return {};
  const std::uint64_t most_bytes = for_images_bytes(memory.caches_bytes);
  return Error{ErrorCode::kUnsupported,
               cameras_text(scenario) + " with " + std::to_string(scenario.estimators.size()) +
                   " estimators need " + bytes_text(memory.images_bytes) +
                   " for images: must be at most " + bytes_text(most_bytes) + " of the limit of " +
                   bytes_text(limit_bytes_) + " (the rest is for maps and pictures)"};
}

}  // namespace overfly::server
