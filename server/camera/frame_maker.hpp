// Frames as the aircraft's cameras take them: world, truth and renderer in one place, so that
// whoever makes the frames of a scenario again gets the same bytes.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/trajectory.hpp"
#include "renderer/renderer.hpp"
#include "server/camera/camera_shot.hpp"
#include "server/camera/camera_unit.hpp"
#include "server/camera/fault_schedule.hpp"
#include "server/camera/renderer_factory.hpp"
#include "server/camera/truth_window.hpp"
#include "server/camera/watched_tiles.hpp"
#include "server/scenario/scenario.hpp"
#include "server/timing/stage_timer.hpp"
#include "terrain/world.hpp"

namespace overfly::engine {

class WorldCache;
struct OpenedWorld;

struct FrameMakerOptions {
  RendererFactory renderer_factory;           ///< EGL where it is empty
  WorldCache* worlds = nullptr;               ///< opened worlds to share; its own when null
  const std::atomic<bool>* cancel = nullptr;  ///< stops the opening
  /// What takes long while it opens, one line at a time.
  std::function<void(const std::string&)> notice;
  StageTimer* stages = nullptr;  ///< where the time is booked
  bool wait_for_tiles = true;    ///< see renderer::CameraRequest
};

/// Used and destroyed on one thread.
class FrameMaker {
 public:
  /// Opens the world, plans the flight and makes the renderer.
  /// @param scenario  must outlive the maker
  /// Errors: kCancelled; whatever world, flight and renderer say.
  static Result<std::unique_ptr<FrameMaker>> open(const Scenario& scenario,
                                                  const FrameMakerOptions& options = {});
  static Result<std::unique_ptr<FrameMaker>> open(Scenario&&, const FrameMakerOptions&) = delete;

  /// Frames of the flight; of a flight of unknown length those of a day.
  [[nodiscard]] std::int64_t frames_total() const { return frames_total_; }
  /// Empty for a flight whose end is not known beforehand.
  [[nodiscard]] std::optional<std::int64_t> duration_ns() const { return duration_ns_; }
  [[nodiscard]] const terrain::World& world() const { return *world_; }
  [[nodiscard]] const std::shared_ptr<const OpenedWorld>& opened_world() const { return opened_; }
  [[nodiscard]] renderer::Renderer& renderer() { return *renderer_; }
  [[nodiscard]] std::string flight_description() const { return truth_->source().description(); }
  [[nodiscard]] std::vector<std::string> flight_warnings() const {
    return truth_->source().warnings();
  }

  /// Frame k as every camera sees it; empty after the end of a flight whose length was not known.
  /// k must grow from call to call. Errors: as the truth's and the renderer's; kIo when a file of
  /// the world could not be read, naming it.
  [[nodiscard]] Result<std::optional<MadeFrame>> make(std::int64_t k);

  /// T_world_camera of every frame of one camera, by the stamps that estimators are told.
  [[nodiscard]] Result<Trajectory> rehearse(std::size_t camera) const;
  /// Depth of the ground along a camera's axis at t = 0 [m]; empty when it meets the sky.
  [[nodiscard]] Result<std::optional<double>> depth_at_start(std::size_t camera);
  /// Draws the first frame once and waits for its ground, so that a flight in real time does not
  /// begin over tiles that are still being read. Nothing for a flight whose end is not known: its
  /// first pose is not either.
  Status fetch_first_view();

 private:
  FrameMaker(const Scenario& scenario, const FrameMakerOptions& options);
  Status open_world();
  Status plan_flight();
  Status open_renderer();
  Status open_cameras();
  [[nodiscard]] Result<renderer::CameraFrame> draw_at_start(std::size_t camera);
  [[nodiscard]] Result<CameraShot> take(std::size_t camera,
                                        std::int64_t k,
                                        const std::vector<AircraftState>& states);
  /// Heights have no way to say that they could not be read, and no picture waits for a tile that
  /// never comes. @param late_tiles  that a picture was drawn without
  [[nodiscard]] Status check_reading(int late_tiles) const;
  /// A world that could not be read is not for the runs to come.
  [[nodiscard]] Error failed(const Error& error);

  const Scenario& scenario_;
  FrameMakerOptions options_;
  std::unique_ptr<StageTimer> own_stages_;
  StageTimer& stages_;
  std::shared_ptr<const OpenedWorld> opened_;
  std::shared_ptr<const terrain::World> world_;  ///< that of opened_
  std::shared_ptr<const WatchedTiles> tiles_;    ///< those of the world
  std::unique_ptr<TruthWindow> truth_;
  std::optional<std::int64_t> duration_ns_;
  std::int64_t frames_total_ = 0;
  std::unique_ptr<renderer::Renderer> renderer_;
  FaultSchedule faults_;
  std::vector<std::unique_ptr<CameraUnit>> cameras_;
  std::int64_t half_window_ns_ = 0;  ///< of the camera that needs the longest
  std::int64_t raster_ns_ = 0;       ///< of the one that needs the finest
};

}  // namespace overfly::engine
