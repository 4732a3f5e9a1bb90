// Makes the picture that a viewer requested: a live image, one read from the run folder, or one
// rendered again.
#pragma once

#include <atomic>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "server/record/rows/rows.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/views/images/frame_painter.hpp"
#include "server/views/picture_request.hpp"
#include "server/views/view_encoding.hpp"
#include "server/views/view_renderers.hpp"
#include "server/views/view_ribbons.hpp"
#include "server/views/view_scene.hpp"

namespace overfly::server {

/// Used and destroyed on one thread.
class ViewPainter {
 public:
  /// Empty while its world is being opened.
  using Painted = FramePainter::Painted;

  /// @param worlds  must outlive this
  /// @param stopping  true cancels the reading of tiles
  ViewPainter(RunManager& runs, WorldOpener& worlds, const std::atomic<bool>& stopping)
      : runs_(runs),
        renderers_(runs, worlds, stopping),
        frames_(runs, renderers_, encoder_, numbers_) {}

  /// Errors: kNotFound if there is nothing to show at that instant; as world and renderer.
  [[nodiscard]] Painted paint(const PictureRequest& request);
  [[nodiscard]] FramePainter::Probed probe(const PixelRequest& request) {
    return frames_.probe(request);
  }
  /// Frees what is kept for a viewer that has gone.
  void forget(std::uint64_t viewer) { encoder_.forget(viewer); }
  /// Closes the files of runs that were deleted.
  void drop_deleted() { renderers_.drop_deleted(); }

 private:
  [[nodiscard]] Painted paint_of(const PictureRequest& request,
                                 const std::shared_ptr<RunTimeline>& timeline);
  [[nodiscard]] Painted paint_scene(const PictureRequest& request,
                                    const std::shared_ptr<RunTimeline>& timeline,
                                    const FrameRow& row);
  /// Adds the tracks of another run; nothing while it has no frame.
  /// @param compared  a second alignment; empty = none
  /// @param origin  of the scene's world frame
  void add_tracks(const SceneTracks& tracks,
                  const std::string& compared,
                  const Geodetic& origin,
                  const SceneShow& show,
                  renderer::SceneContent* content,
                  std::vector<PlacedLabel>* places);
  /// Of the run's estimators at a frame, world frame.
  std::vector<Eigen::Vector3f> map_points(const PictureRequest& request,
                                          const RunTimeline& timeline,
                                          const ViewRibbons& ribbons,
                                          const FrameRow& row);
  /// Null without an alignment.
  const ViewRibbons* compared_ribbons(const std::shared_ptr<RunTimeline>& timeline,
                                      const std::string& alignment);
  ViewRibbons& ribbons_of(const std::shared_ptr<RunTimeline>& timeline,
                          const std::string& alignment);

  RunManager& runs_;
  ViewRenderers renderers_;
  PictureEncoder encoder_;
  RecordedNumbers numbers_;
  FramePainter frames_;
  std::list<ViewRibbons> ribbons_;  ///< of the runs and alignments viewed most recently
};

}  // namespace overfly::server
