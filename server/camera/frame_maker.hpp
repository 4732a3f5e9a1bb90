// Makes the frames of the aircraft's cameras. World, truth and renderer are combined in one place,
// so that rendering a scenario again gives the same bytes.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "flight/sensors/sensor_suite.hpp"
#include "renderer/renderer.hpp"
#include "server/camera/camera_shot.hpp"
#include "server/camera/camera_unit.hpp"
#include "server/camera/faults/fault_schedule.hpp"
#include "server/camera/renderer_factory.hpp"
#include "server/camera/truth_window.hpp"
#include "server/camera/watched_tiles.hpp"
#include "server/imagery/flight_images.hpp"
#include "server/record/truth_samples.hpp"
#include "server/scenario/scenario.hpp"
#include "server/timing/stage_timer.hpp"
#include "terrain/world.hpp"

namespace overfly::server {

class FrameCache;
class WorldCache;
struct OpenedWorld;

struct FrameMakerOptions {
  RendererFactory renderer_factory;           ///< EGL if empty
  WorldCache* worlds = nullptr;               ///< cache of opened worlds to share; private if null
  const std::atomic<bool>* cancel = nullptr;  ///< stops the opening
  /// Called with one line before each slow step of the opening.
  std::function<void(const std::string&)> notice;
  StageTimer* stages = nullptr;  ///< measures the time of each stage
  bool wait_for_tiles = true;    ///< else late ones are replaced by coarser ones
  /// Opens the flight over the opened world; create_truth if empty.
  std::function<Result<std::unique_ptr<TruthSource>>(const terrain::World&)> open_truth;
  TruthSampleFile* truth_samples = nullptr;  ///< where the truth is recorded; may be null
  /// Date of the flight at t = 0. If given, the scenario's other sensors measure.
  std::optional<std::int64_t> sensing_from_utc_ns;
  /// Pictures of earlier flights, and for later ones; may be null, must outlive the maker.
  FrameCache* frame_cache = nullptr;
  /// Where the messages of a live vehicle are recorded; empty: nowhere.
  std::filesystem::path vehicle_log;
};

/// Used and destroyed on one thread.
class FrameMaker {
 public:
  /// Opens the world, plans the flight and creates the renderer.
  /// @param scenario  must outlive the maker
  /// Errors: kCancelled; any error of world, flight and renderer.
  static Result<std::unique_ptr<FrameMaker>> open(const Scenario& scenario,
                                                  const FrameMakerOptions& options = {});
  static Result<std::unique_ptr<FrameMaker>> open(Scenario&&, const FrameMakerOptions&) = delete;

  /// Number of frames of the flight; for a flight of unknown length, that of one day.
  [[nodiscard]] std::int64_t frames_total() const { return frames_total_; }
  /// Time of frame k: by the cameras' rate, or that of the k-th recorded image.
  [[nodiscard]] std::int64_t frame_ns(std::int64_t k) const;
  /// Empty for a flight whose end is not known in advance.
  [[nodiscard]] std::optional<std::int64_t> duration_ns() const { return duration_ns_; }
  [[nodiscard]] const terrain::World& world() const { return *world_; }
  [[nodiscard]] const std::shared_ptr<const OpenedWorld>& opened_world() const { return opened_; }
  [[nodiscard]] renderer::Renderer& renderer() { return *renderer_; }
  [[nodiscard]] std::string flight_description() const { return truth_->source().description(); }
  /// As TruthSource::log_start_ns.
  [[nodiscard]] std::optional<std::int64_t> log_start_ns() const {
    return truth_->source().log_start_ns();
  }
  [[nodiscard]] std::vector<std::string> flight_warnings() const {
    return truth_->source().warnings();
  }
  /// As TruthSource::take_events and take_status.
  [[nodiscard]] std::vector<FlightEvent> take_flight_events(std::int64_t t_ns) {
    return truth_->source().take_events(t_ns);
  }
  [[nodiscard]] std::optional<VehicleStatus> take_vehicle_status(std::int64_t t_ns) {
    return truth_->source().take_status(t_ns);
  }
  /// As SampleSource::sensor_report; empty if the flight's aircraft has no sensors of its own.
  [[nodiscard]] std::string sensor_report() const;
  /// Of the recorded images.
  [[nodiscard]] std::vector<std::string> image_warnings() const;

  /// These three: see TruthSource.
  void begin_flight() { truth_->source().begin(); }
  [[nodiscard]] std::shared_ptr<EstimateReceiver> estimate_receiver() const {
    return truth_->source().estimate_receiver();
  }
  [[nodiscard]] std::optional<std::int64_t> heard_ns() const { return truth_->source().heard_ns(); }

  /// Frame k as seen by every camera; empty after the end of a flight of unknown length. k must
  /// increase from call to call.
  /// Errors: as the truth's and the renderer's; kIo naming a file of the world that could not be
  /// read.
  [[nodiscard]] Result<std::optional<MadeFrame>> make(std::int64_t k);

  /// Records the truth of one more frame period after the last frame, as far as the flight goes on,
  /// so that inertial data can be computed up to that frame. Returns the samples of the other
  /// sensors in that period.
  Result<SensorSamples> record_last_period();
  /// Draws the first frame once and waits for its tiles, so that a real-time flight does not start
  /// while its tiles are still being read. Does nothing for a flight whose end is not known, since
  /// its first pose is not known either.
  Status fetch_first_view();

 private:
  FrameMaker(const Scenario& scenario, const FrameMakerOptions& options);
  Status open_world();
  Status plan_flight();
  Status open_images();
  Status open_renderer();
  Status open_cameras();
  /// The samples until a time: simulated ones of the scenario's sensors, of all others those of the
  /// aircraft that flies.
  [[nodiscard]] SensorSamples take_samples(std::int64_t t_ns);
  [[nodiscard]] Result<CameraShot> take(std::size_t camera,
                                        std::int64_t k,
                                        const std::vector<AircraftState>& states);
  /// The recorded image of frame k.
  /// @param rendered  the shots so far, by camera
  [[nodiscard]] Result<CameraShot> fetch(std::size_t camera,
                                         std::int64_t k,
                                         const std::vector<AircraftState>& states,
                                         const std::vector<CameraShot>& rendered);
  /// Checks for read errors, because height queries cannot report them and a frame does not wait
  /// for a tile that cannot be read.
  /// @param late_tiles  tiles that a frame was drawn without
  [[nodiscard]] Status check_reading(int late_tiles) const;
  /// Removes a world that could not be read from the cache, so that later runs open it again.
  [[nodiscard]] Error failed(const Error& error);

  const Scenario& scenario_;
  FrameMakerOptions options_;
  std::unique_ptr<StageTimer> own_stages_;
  StageTimer& stages_;
  std::shared_ptr<const OpenedWorld> opened_;
  std::shared_ptr<const WatchedTiles> tiles_;     ///< those of opened_
  std::shared_ptr<const terrain::World> world_;   ///< the world of opened_, with tiles_
  std::unique_ptr<flight::SensorSuite> sensors_;  ///< null without sensors
  std::unique_ptr<TruthWindow> truth_;
  std::optional<std::int64_t> duration_ns_;
  std::unique_ptr<FlightImages> images_;  ///< null if all images are rendered
  std::int64_t frames_total_ = 0;
  std::int64_t next_frame_ = 0;  ///< the one after the last made frame
  std::unique_ptr<renderer::Renderer> renderer_;
  FaultSchedule faults_;
  std::vector<std::unique_ptr<CameraUnit>> cameras_;
  ShutterWindow window_;
};

}  // namespace overfly::server
