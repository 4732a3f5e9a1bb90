// Makes a run's camera image again at any frame, for playback of images that were not recorded:
// rendered images by rendering, real ones by reading their source.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/result.hpp"
#include "server/camera/camera_unit.hpp"
#include "server/camera/faults/fault_schedule.hpp"
#include "server/camera/truth_window.hpp"
#include "server/imagery/image_source.hpp"
#include "server/record/rows/rows.hpp"
#include "server/scenario/scenario.hpp"
#include "terrain/world.hpp"

namespace overfly::server {

/// With the same renderer the image equals that of the run: shutter, vibration, lens faults,
/// exposure and noise are those of the frame. Only a frozen camera gives the image that it would
/// have taken. Used by one thread.
class FrameRemaker {
 public:
  /// @param folder  of the run
  /// Errors: as open_flown_truth and CameraUnit::create.
  static Result<std::unique_ptr<FrameRemaker>> create(std::filesystem::path folder,
                                                      Scenario scenario,
                                                      std::shared_ptr<const terrain::World> world);

  /// @param row  of the frame, from the run's record; its exposure is used
  /// Errors: as the truth's and the renderer's; kConflict if the flight's camera was elsewhere than
  /// the row says.
  [[nodiscard]] Result<Image> make(std::size_t camera,
                                   const FrameRow& row,
                                   renderer::Renderer& renderer);
  /// How the frame's image was drawn; of a camera with recorded images, a camera at rest at the
  /// row's pose. Errors: as make.
  [[nodiscard]] Result<renderer::CameraRequest> request(std::size_t camera, const FrameRow& row);
  /// Whether the frame's image is what the renderer drew: of no real camera, without sensor model
  /// and faults.
  [[nodiscard]] bool is_as_rendered(std::size_t camera, const FrameRow& row) const;
  /// The frame as an ideal camera would have taken it (CameraUnit::ideal), at any pose.
  [[nodiscard]] Result<Image> make_ideal(std::size_t camera,
                                         const FrameRow& row,
                                         const Pose& T_world_camera,
                                         renderer::Renderer& renderer);
  /// Whether the camera's images were recorded by a real camera.
  [[nodiscard]] bool is_real(std::size_t camera) const {
    return camera < scenario_.cameras.size() && scenario_.cameras[camera].images.has_value();
  }

 private:
  FrameRemaker(std::filesystem::path folder,
               Scenario scenario,
               std::shared_ptr<const terrain::World> world);
  [[nodiscard]] Status check_camera(std::size_t camera) const;
  /// The recorded image of a row.
  [[nodiscard]] Result<Image> read_again(const CameraSpec& camera, const FrameRow& row);
  [[nodiscard]] Result<std::optional<std::vector<AircraftState>>> states_around(
      const FrameRow& row);

  std::filesystem::path folder_;
  Scenario scenario_;
  std::shared_ptr<const terrain::World> world_;
  std::vector<std::unique_ptr<CameraUnit>> cameras_;
  ShutterWindow window_;
  std::unique_ptr<TruthWindow> truth_;
  std::unique_ptr<ImageSource> recorded_;  ///< opened when it is needed
  std::int64_t asked_ns_ = 0;              ///< latest time requested from the truth
};

}  // namespace overfly::server
