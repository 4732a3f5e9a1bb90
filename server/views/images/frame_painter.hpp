// Pictures of a camera's frames: its image, depth, errors, an estimator's debug image; and what a
// pixel shows.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/result.hpp"
#include "server/record/recorded_numbers.hpp"
#include "server/record/rows/rows.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/views/images/frame_images.hpp"
#include "server/views/picture_request.hpp"
#include "server/views/view_encoding.hpp"
#include "server/views/view_renderers.hpp"

namespace overfly::server {

/// Used on one thread.
class FramePainter {
 public:
  /// Empty while the run's world is being opened.
  using Painted = Result<std::optional<Picture>>;
  using Probed = Result<std::optional<PixelValue>>;

  /// The references must outlive this.
  FramePainter(RunManager& runs,
               ViewRenderers& renderers,
               PictureEncoder& encoder,
               RecordedNumbers& numbers)
      : runs_(runs),
        renderers_(renderers),
        encoder_(encoder),
        numbers_(numbers),
        images_(runs, renderers) {}

  /// Errors: kNotFound if there is nothing to show; as world and renderer.
  [[nodiscard]] Painted camera(const PictureRequest& request, const ViewedFrame& frame);
  [[nodiscard]] Painted depth(const PictureRequest& request, const ViewedFrame& frame);
  [[nodiscard]] Painted error(const PictureRequest& request,
                              const RunTimeline& timeline,
                              const ViewedFrame& frame);
  /// @param row  at the instant; the picture is the last one recorded up to it
  [[nodiscard]] Painted debug(const PictureRequest& request,
                              const RunTimeline& timeline,
                              const FrameRow& row);
  /// The camera's image for a scene; empty while the world is being opened. Errors: as camera.
  [[nodiscard]] Result<std::optional<renderer::SceneContent::Projection>> projection(
      const ViewedFrame& frame) {
    return images_.projection(frame);
  }
  /// Errors: kInvalidArgument for a pixel outside the image; as camera.
  [[nodiscard]] Probed probe(const PixelRequest& request);

 private:
  [[nodiscard]] Painted previewed(const PictureRequest& request,
                                  const ViewedFrame& frame,
                                  const std::shared_ptr<const Image>& half);
  [[nodiscard]] Painted scaled(const PictureRequest& request,
                               const ViewedFrame& frame,
                               const ScaledImage& image);
  /// The frame whose views an error picture compares, and the comparison.
  struct ComparedView {
    ViewedFrame frame;
    Comparison comparison;
  };
  /// @param frame  at the viewer's instant; that of an estimate may be earlier
  [[nodiscard]] static Result<ComparedView> compared_view(const ErrorOf& error,
                                                          const RunTimeline& timeline,
                                                          const std::string& alignment,
                                                          const ViewedFrame& frame);
  /// Fills in what the pixel's line of sight meets. False while the world is being opened.
  [[nodiscard]] Result<bool> find_ground(const ViewedFrame& frame,
                                         const Eigen::Vector2d& pixel,
                                         PixelValue* value);

  RunManager& runs_;
  ViewRenderers& renderers_;
  PictureEncoder& encoder_;
  RecordedNumbers& numbers_;
  FrameImages images_;
};

}  // namespace overfly::server
