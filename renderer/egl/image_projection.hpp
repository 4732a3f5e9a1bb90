// Lays a camera's image onto the ground that is drawn in another view.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "core/camera/image.hpp"
#include "renderer/egl/gl_objects.hpp"
#include "renderer/egl/gl_program.hpp"
#include "renderer/ground/view.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer::egl {

/// GLSL: `bool seen_by_camera(vec3 place_m, out vec3 seen)` gives the colour of the camera's pixel
/// that sees a place of the view's camera frame; false if none does. Goes before the source that
/// calls it.
extern const char* const kProjectionSource;

/// Keeps the textures of the last image, so that a view of it can be turned at little cost.
class ImageProjection {
 public:
  /// Sets image and camera for a view.
  void prepare(const SceneContent::Projection& projection, const View& view);
  /// Sets the uniforms of a program in use and binds the textures; texture unit 0 stays as it is.
  void use(const GlProgram& program) const;

 private:
  void upload(const SceneContent::Projection& projection);

  std::shared_ptr<const Image> image_;  ///< uploaded
  std::shared_ptr<const DepthImage> depth_;
  GlTexture image_texture_, depth_texture_;
  CameraModel camera_;
  /// T_seen_view of the first and the last row.
  Eigen::Matrix3f R_first_, R_last_;
  Eigen::Vector3f p_first_, p_last_;
};

}  // namespace overfly::renderer::egl
