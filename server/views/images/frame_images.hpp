// Images of the frames that viewers look at: as the camera took them, as an ideal camera would have
// taken them, their depth, and differences between these. The latest are kept.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <optional>
#include <string>

#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "server/record/rows/rows.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/views/picture_request.hpp"
#include "server/views/view_renderers.hpp"

namespace overfly::server {

/// A frame of one of a run's cameras.
struct ViewedFrame {
  std::string run_id;
  const RunTimeline* timeline = nullptr;
  std::size_t camera = 0;  ///< index
  FrameRow row;
};

/// An image, with the scale of its colours if they stand for a quantity.
struct ScaledImage {
  std::shared_ptr<const Image> image;
  std::optional<ColourScale> scale;
};

/// What a difference is made of: the ideal view from an estimated pose minus that from the true
/// one; without an estimate, the received image minus that of an ideal camera (CameraUnit::ideal).
struct Comparison {
  std::optional<Pose> T_world_camera_estimate;
};

/// Used on one thread.
class FrameImages {
 public:
  /// Empty while the run's world is being opened.
  template <typename T>
  using Made = Result<std::optional<T>>;
  using SharedImage = std::shared_ptr<const Image>;

  /// @param runs, renderers  must outlive this
  FrameImages(RunManager& runs, ViewRenderers& renderers) : runs_(runs), renderers_(renderers) {}

  /// As the camera delivered it: the live image, the recorded one, or rendered again.
  /// Errors: as ViewRenderers and FrameRemaker.
  [[nodiscard]] Made<SharedImage> received(const ViewedFrame& frame);
  /// Keeps a live image of the camera of `frame`, which may be asked for when it is not the newest.
  void remember(const ViewedFrame& frame, const StampedImage& live);
  /// What the camera saw, rendered in half its size. Null if the image is known already, or if it
  /// is not only rendered (FrameRemaker::is_as_rendered): then received() gives it.
  [[nodiscard]] Made<SharedImage> preview(const ViewedFrame& frame);
  /// The coloured depth of the ground along the optical axis, at most `max_width_px` wide.
  [[nodiscard]] Made<ScaledImage> depth(const ViewedFrame& frame, int max_width_px);
  /// The received image as it lies on the ground, reduced if it is large.
  [[nodiscard]] Made<renderer::SceneContent::Projection> projection(const ViewedFrame& frame);
  /// The difference of two images, coloured. Errors: in addition kNotFound if the estimated pose is
  /// below the ground or not on the earth; kConflict if the images have different sizes.
  [[nodiscard]] Made<ScaledImage> difference(const ViewedFrame& frame,
                                             const Comparison& comparison);
  /// The same difference at a pixel.
  [[nodiscard]] Made<int> difference_at(const ViewedFrame& frame,
                                        const Comparison& comparison,
                                        int x_px,
                                        int y_px);

 private:
  struct Kept {
    std::string key;
    ScaledImage image;
  };
  const ScaledImage* find(const std::string& key);
  void keep(const std::string& key, const ScaledImage& image);
  [[nodiscard]] Made<SharedImage> ideal(const ViewedFrame& frame, const Pose& T_world_camera);
  [[nodiscard]] Made<SharedImage> from_estimate(const ViewedFrame& frame,
                                                const Pose& T_world_camera);
  /// The images that are compared, of equal size.
  struct Pair {
    SharedImage a, b;
  };
  [[nodiscard]] Made<Pair> compared(const ViewedFrame& frame, const Comparison& comparison);

  RunManager& runs_;
  ViewRenderers& renderers_;
  std::list<Kept> kept_;  ///< most recently used first
  std::size_t kept_bytes_ = 0;
  /// Of the frame that lay on the ground last.
  std::string projected_key_;
  renderer::SceneContent::Projection projected_;
};

/// How the frame was drawn. Where that is not known (the truth of a live run's newest frames may
/// not be on the disk yet), a camera at rest at the recorded pose. Errors: as
/// FrameRemaker::request.
[[nodiscard]] Result<renderer::CameraRequest> drawn_request(const ViewedFrame& frame,
                                                            FrameRemaker& maker);

/// A camera whose image is that of `camera` with half the pixels each way.
[[nodiscard]] CameraModel half_sized(const CameraModel& camera);

}  // namespace overfly::server
