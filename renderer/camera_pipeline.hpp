// Renders camera images with several in flight: while a GPU draws and copies one, the next is
// prepared. For callers that make many images and do not need each at once.
#pragma once

#include <memory>

#include "core/result.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer {

/// Not thread-safe: create, use and destroy on one thread.
class CameraPipeline {
 public:
  /// Draws with OpenGL. @param in_flight  number of simultaneous images, in [1, 16]
  /// Errors: as create_egl_renderer; kInvalidArgument for `in_flight`.
  static Result<std::unique_ptr<CameraPipeline>> create(
      std::shared_ptr<const terrain::TileSource> tiles,
      const RendererOptions& options,
      int in_flight);
  virtual ~CameraPipeline() = default;

  /// Starts an image. Errors: as Renderer::render_camera; kConflict if `in_flight` images are
  /// already begun.
  virtual Status begin(const CameraRequest& request) = 0;
  /// Returns the oldest image that was begun, with the same bytes as Renderer::render_camera.
  /// Errors: kConflict if none is begun; kInternal if OpenGL fails.
  virtual Result<CameraFrame> finish() = 0;
  [[nodiscard]] virtual RendererInfo info() const = 0;
};

}  // namespace overfly::renderer
