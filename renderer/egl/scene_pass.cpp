#include "renderer/egl/scene_pass.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "renderer/scene/aircraft_mesh.hpp"
#include "renderer/scene/ribbon_mesh.hpp"

namespace overfly::renderer::egl {

namespace {

constexpr int kSamples = 4;
constexpr double kRibbonMinPx = 3.0;
constexpr double kAircraftMinPx = 44.0;
/// Coarser than for the camera, since the ground has one colour and the view is only for display.
constexpr MeshLimits kSceneMesh{96.0, 1.0};

constexpr const char* kSkyVertexSource = R"(#version 330 core
uniform vec4 projection;
out vec2 ray;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  ray = (corner - projection.zw) / projection.xy;
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";

constexpr const char* kSkyFragmentSource = R"(#version 330 core
uniform vec3 up;
uniform vec3 haze;
in vec2 ray;
out vec4 colour;
void main() {
  float height = dot(normalize(vec3(ray, 1.0)), up);
  float a = clamp(height, 0.0, 1.0);
  vec3 low = mix(haze, vec3(0.56, 0.73, 0.91), smoothstep(0.0, 0.22, a));
  colour = vec4(mix(low, vec3(0.20, 0.42, 0.74), smoothstep(0.12, 0.95, a)), 1.0);
}
)";

constexpr const char* kSceneVertexSource = R"(#version 330 core
uniform vec4 projection;
uniform float near;
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 rgba;
out vec4 tint;
void main() {
  tint = rgba;
  gl_Position = vec4(projection.xy * position.xy + projection.zw * position.z, near, position.z);
}
)";

constexpr const char* kSceneFragmentSource = R"(#version 330 core
in vec4 tint;
out vec4 colour;
void main() { colour = tint; }
)";

/// True if a corner of the image looks less than 10 deg below the horizon.
bool sees_sky(const View& view) {
  const PinholeCamera& camera = view.camera;
  for (const double x : {-0.5, camera.width_px - 0.5}) {
    for (const double y : {-0.5, camera.height_px - 0.5}) {
      const Eigen::Vector3d ray = view.R_camera_world.transpose() * camera.ray({x, y});
      if (ray.z() / ray.norm() > -0.17) return true;
    }
  }
  return false;
}

Rgba point_colour() { return {0.25F, 1.0F, 0.45F, 1.0F}; }

}  // namespace

Result<ScenePass> ScenePass::create() {
  Result<GlProgram> sky = GlProgram::link(kSkyVertexSource, kSkyFragmentSource);
  if (!sky.ok()) return sky.error();
  Result<GlProgram> overlay = GlProgram::link(kSceneVertexSource, kSceneFragmentSource);
  if (!overlay.ok()) return overlay.error();
  return ScenePass(std::move(*sky), std::move(*overlay));
}

ScenePass::ScenePass(GlProgram sky, GlProgram overlay)
    : sky_(std::move(sky)),
      overlay_(std::move(overlay)),
      no_vertices_(GlVertexArray::make()),
      vertex_array_(GlVertexArray::make()),
      vertices_(GlBuffer::make()) {
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(SceneVertex), nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1,
                        4,
                        GL_UNSIGNED_BYTE,
                        GL_TRUE,
                        sizeof(SceneVertex),
                        buffer_offset(offsetof(SceneVertex, rgba)));
}

Status ScenePass::prepare_target(const PinholeCamera& camera) {
  if (!target_ || !target_->fits(camera.width_px, camera.height_px)) {
    Result<RenderTarget> target =
        RenderTarget::create(camera.width_px, camera.height_px, TargetFormat::kRgba8, kSamples);
    if (!target.ok()) return target.error();
    target_ = std::move(*target);
  }
  target_->bind();
  return {};
}

void ScenePass::draw_sky(const View& view) {
  glDisable(GL_DEPTH_TEST);
  sky_.use();
  set_projection(sky_, view.camera);
  const Eigen::Vector3f up = view.R_camera_world.col(2).cast<float>();
  glUniform3f(sky_.uniform("up"), up.x(), up.y(), up.z());
  glUniform3fv(sky_.uniform("haze"), 1, kHazeRgb);
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void ScenePass::draw_triangles(const SceneTriangles& triangles, bool translucent) {
  if (triangles.vertices().empty()) return;
  overlay_.use();
  set_projection(overlay_, triangles.view().camera);
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glBufferData(GL_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(triangles.vertices().size() * sizeof(SceneVertex)),
               triangles.vertices().data(),
               GL_STREAM_DRAW);
  if (translucent) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
  }
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(triangles.vertices().size()));
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
}

Result<Image> ScenePass::draw(const SceneContent& content,
                              const View& view,
                              const terrain::TileSource& tiles,
                              GroundPatches& patches,
                              GroundPass& ground,
                              TileTextures& textures,
                              std::int64_t tile_wait_ns) {
  SceneTriangles solid(view), translucent(view);
  for (std::size_t i = 0; i < content.ribbons.size(); ++i) {
    // Where ribbons coincide, the later one is visible.
    solid.pull_nearer(4e-4 * static_cast<double>(i));
    translucent.pull_nearer(4e-4 * static_cast<double>(i));
    add_ribbon(content.ribbons[i], kRibbonMinPx, solid, translucent);
  }
  translucent.pull_nearer(0.0);
  solid.pull_nearer(2e-3);
  for (const Eigen::Vector3f& point : content.points) {
    solid.add_mark(view.camera_from_world(point.cast<double>()), 3.0, point_colour());
  }
  for (const SceneContent::Line& line : content.lines) {
    solid.add_line(view.camera_from_world(line.from_world),
                   view.camera_from_world(line.to_world),
                   line.width_px,
                   Rgba{line.rgb[0], line.rgb[1], line.rgb[2], 1.0F});
  }
  if (content.frustum) add_frustum(*content.frustum, tiles, translucent);
  for (const SceneContent::Aircraft& aircraft : content.aircraft) {
    SceneTriangles& triangles = aircraft.ghost ? translucent : solid;
    triangles.pull_nearer(3e-3);
    add_aircraft(aircraft, kAircraftMinPx, triangles);
  }

  if (Status status = prepare_target(view.camera); !status) return status.error();
  glDepthMask(GL_TRUE);
  glClearDepth(0.0);
  // Beyond the reach of the ground (kMaxReachM) there is haze.
  glClearColor(kHazeRgb[0], kHazeRgb[1], kHazeRgb[2], 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  if (sees_sky(view)) draw_sky(view);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  const GroundMesh mesh = build_ground_mesh(patches, view, kSceneMesh);
  GroundLook look;
  look.output = GroundLook::Output::kHazyColour;
  look.format = PixelFormat::kRgb8;
  look.tile_wait_ns = tile_wait_ns;
  if (content.projection) {
    projection_.prepare(*content.projection, view);
    look.projection = &projection_;
  }
  if (Status drawn = ground.draw(mesh, view.camera, textures, look); !drawn) {
    (void)textures.end_view();
    return drawn.error();
  }
  draw_triangles(solid, false);
  draw_triangles(translucent, true);
  Image image;
  target_->read(image);
  (void)textures.end_view();
  return image;
}

}  // namespace overfly::renderer::egl
