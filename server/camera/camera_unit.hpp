// One camera in operation: its shutter along the true trajectory, and its sensor.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/motion/truth_source.hpp"
#include "core/result.hpp"
#include "server/camera/camera_shot.hpp"
#include "server/camera/faults/fault_schedule.hpp"
#include "server/scenario/camera_spec.hpp"

namespace overfly::server {

/// Used by one thread.
class CameraUnit {
 public:
  /// @param spec  must outlive the unit
  /// @param index  among the scenario's cameras; together with `seed` it seeds noise and vibration
  /// Errors: as Sensor::create and MountVibration::create, with the camera's name.
  static Result<std::unique_ptr<CameraUnit>> create(const CameraSpec& spec,
                                                    std::size_t index,
                                                    std::uint64_t seed);

  /// Half of the longest time in which one image is exposed and read out; 0 = an instant.
  [[nodiscard]] std::int64_t half_window_ns() const { return half_window_ns_; }
  /// Sampling period of the truth that the shutter needs: 1 ms, or a tenth of the period of the
  /// fastest vibration.
  [[nodiscard]] std::int64_t raster_ns() const { return raster_ns_; }
  [[nodiscard]] Pose T_world_camera(const Pose& T_world_body, std::int64_t t_ns) const;

  /// @param states  from TruthWindow::around, over at least half_window_ns()
  /// @param setting  exposure; if empty, the sensor's next one
  [[nodiscard]] Result<renderer::CameraRequest> request(
      const std::vector<AircraftState>& states,
      std::int64_t t_ns,
      const std::optional<sensor::ExposureSetting>& setting = {}) const;
  /// The next exposure; empty without a sensor model.
  [[nodiscard]] std::optional<sensor::ExposureSetting> next_setting() const;

  /// Converts the rendered light into the camera's image: faults on the lens, sensor, frozen image.
  /// @param setting  forces the exposure of a frame that is taken out of order: auto-exposure then
  ///                 does not adapt, and a frozen camera gives the image that it would have taken
  Status develop(renderer::CameraFrame drawn,
                 const FrameFaults& faults,
                 std::int64_t frame,
                 CameraShot& shot,
                 const std::optional<sensor::ExposureSetting>& setting = {});
  /// The image that an ideal camera of the same geometry, exposure and response would take at a
  /// pose: in an instant, without blur, vignetting, noise and faults.
  /// @param setting  exposure; if empty, that of the sensor model
  [[nodiscard]] Result<Image> ideal(const Pose& T_world_camera,
                                    std::int64_t t_ns,
                                    std::int64_t frame,
                                    const std::optional<sensor::ExposureSetting>& setting,
                                    renderer::Renderer& renderer) const;
  /// Keeps the last image, for a camera that may freeze.
  void keep_last_image() { keeps_last_ = true; }

 private:
  CameraUnit(const CameraSpec& spec, std::uint64_t seed) : spec_(spec), seed_(seed) {}
  void plan_window();
  /// The sensor's model without auto-exposure, fixed at the setting.
  [[nodiscard]] sensor::SensorModel fixed_at(const sensor::ExposureSetting& setting) const;
  [[nodiscard]] Result<sensor::SensorImage> exposed_with(const sensor::ExposureSetting& setting,
                                                         const RadianceImage& radiance,
                                                         std::int64_t frame) const;

  const CameraSpec& spec_;
  std::uint64_t seed_;
  std::int64_t half_window_ns_ = 0;
  std::int64_t raster_ns_ = 1'000'000;
  std::unique_ptr<sensor::Sensor> sensor_;
  std::optional<sensor::MountVibration> vibration_;
  bool keeps_last_ = false;
  Image last_image_;
  Image16 last_image16_;
};

/// The truth that the shutters of several cameras need around a frame.
struct ShutterWindow {
  std::int64_t half_ns = 0;            ///< of the camera that needs the longest
  std::int64_t raster_ns = 1'000'000;  ///< of the camera that needs the finest

  [[nodiscard]] static ShutterWindow of(const std::vector<std::unique_ptr<CameraUnit>>& cameras);
};

}  // namespace overfly::server
