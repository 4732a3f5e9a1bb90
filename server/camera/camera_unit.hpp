// One camera at work: its shutter along the truth, and what its sensor makes of the light.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/result.hpp"
#include "core/truth_source.hpp"
#include "server/camera/camera_shot.hpp"
#include "server/camera/fault_schedule.hpp"
#include "server/scenario/camera_spec.hpp"

namespace overfly::engine {

/// Used by one thread.
class CameraUnit {
 public:
  /// @param spec   must outlive the unit
  /// @param index  among the scenario's cameras; with `seed` it seeds noise and vibration
  /// Errors: as Sensor::create and MountVibration::create, with the camera's name.
  static Result<std::unique_ptr<CameraUnit>> create(const CameraSpec& spec,
                                                    std::size_t index,
                                                    std::uint64_t seed);

  /// Half of the longest time over which one image is exposed and read out; 0 = an instant.
  [[nodiscard]] std::int64_t half_window_ns() const { return half_window_ns_; }
  /// Raster of the truth that its shutter needs: 1 ms, or a tenth of the fastest vibration's
  /// period.
  [[nodiscard]] std::int64_t raster_ns() const { return raster_ns_; }
  [[nodiscard]] Pose T_world_camera(const Pose& T_world_body, std::int64_t t_ns) const;

  /// @param states   as TruthWindow::around gives them, over half_window_ns() at least
  /// @param setting  of the exposure; the sensor's next one where it is empty
  [[nodiscard]] Result<renderer::CameraRequest> request(
      const std::vector<AircraftState>& states,
      std::int64_t t_ns,
      const std::optional<renderer::ExposureSetting>& setting = {}) const;
  /// The next exposure; empty without a sensor model.
  [[nodiscard]] std::optional<renderer::ExposureSetting> next_setting() const;

  /// Makes the drawn light into the camera's image: faults on the lens, sensor, frozen image.
  /// @param setting  forces the exposure, for a frame taken out of its turn: auto-exposure then
  ///                 learns nothing, and a frozen camera shows what it would have seen
  Status develop(renderer::CameraFrame drawn,
                 const FrameFaults& faults,
                 std::int64_t frame,
                 CameraShot& shot,
                 const std::optional<renderer::ExposureSetting>& setting = {});
  /// Keeps the last image, for a camera that may freeze.
  void keep_last_image() { keeps_last_ = true; }

 private:
  CameraUnit(const CameraSpec& spec, std::uint64_t seed) : spec_(spec), seed_(seed) {}
  void plan_window();
  [[nodiscard]] Result<renderer::SensorImage> exposed_with(const renderer::ExposureSetting& setting,
                                                           const RadianceImage& radiance,
                                                           std::int64_t frame) const;

  const CameraSpec& spec_;
  std::uint64_t seed_;
  std::int64_t half_window_ns_ = 0;
  std::int64_t raster_ns_ = 1'000'000;
  std::unique_ptr<renderer::Sensor> sensor_;
  std::optional<renderer::MountVibration> vibration_;
  bool keeps_last_ = false;
  Image last_image_;
  Image16 last_image16_;
};

}  // namespace overfly::engine
