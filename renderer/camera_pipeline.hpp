// Renders camera images with several in flight: while a GPU draws and copies one, the next is
// prepared. For callers that make many images and do not need each at once.
#pragma once

#include <memory>

#include "core/result.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer {

namespace egl {
class EglRenderer;
}

/// Draws with OpenGL. Not thread-safe: create, use and destroy on one thread.
class CameraPipeline {
 public:
  /// @param in_flight  number of simultaneous images, in [1, 16]
  /// Errors: as create_egl_renderer; kInvalidArgument for `in_flight`.
  static Result<CameraPipeline> create(std::shared_ptr<const terrain::TileSource> tiles,
                                       const RendererOptions& options,
                                       int in_flight);
  ~CameraPipeline();
  CameraPipeline(CameraPipeline&&) noexcept;
  CameraPipeline& operator=(CameraPipeline&&) noexcept;

  /// Starts an image. Errors: as Renderer::render_camera, except for heights that could not be
  /// read; kConflict if `in_flight` images are already begun.
  [[nodiscard]] Status begin(const CameraRequest& request);
  /// Returns the oldest image that was begun, with the same bytes as Renderer::render_camera.
  /// Errors: kConflict if none is begun; kInternal if OpenGL fails; kIo if a height could not be
  /// read.
  [[nodiscard]] Result<CameraFrame> finish();

 private:
  explicit CameraPipeline(std::unique_ptr<egl::EglRenderer> renderer);
  std::unique_ptr<egl::EglRenderer> renderer_;
};

}  // namespace overfly::renderer
