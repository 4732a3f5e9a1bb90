// The camera's images with several in flight: while a GPU draws and copies one, the next is
// prepared. For whoever makes many images and needs none of them at once.
#pragma once

#include <memory>

#include "core/result.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer {

/// Not thread-safe: create, use and destroy on one thread.
class CameraPipeline {
 public:
  /// Draws with OpenGL. @param in_flight  images at a time, in [1, 16]
  /// Errors: as create_egl_renderer; kInvalidArgument for `in_flight`.
  static Result<std::unique_ptr<CameraPipeline>> create(
      std::shared_ptr<const terrain::TileSource> tiles,
      const RendererOptions& options,
      int in_flight);
  virtual ~CameraPipeline() = default;

  /// Starts an image. Errors: as Renderer::render_camera; kConflict when `in_flight` of them are
  /// begun and none finished.
  virtual Status begin(const CameraRequest& request) = 0;
  /// The oldest image that was begun, the same bytes as Renderer::render_camera gives.
  /// Errors: kConflict when none is begun; kInternal when OpenGL fails.
  virtual Result<CameraFrame> finish() = 0;
  [[nodiscard]] virtual RendererInfo info() const = 0;
};

}  // namespace overfly::renderer
