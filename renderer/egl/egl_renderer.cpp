#include <limits>
#include <map>
#include <utility>

#include "renderer/egl/egl_context.hpp"
#include "renderer/egl/ground_pass.hpp"
#include "renderer/egl/render_target.hpp"
#include "renderer/egl/scene_pass.hpp"
#include "renderer/egl/tile_textures.hpp"
#include "renderer/frame_statistics.hpp"
#include "renderer/renderer.hpp"
#include "renderer/request_check.hpp"

namespace overfly::renderer {

namespace egl {
namespace {

/// Haze of the horizon, the camera's sky.
constexpr float kSkyRgb[3] = {0.72F, 0.80F, 0.88F};
constexpr float kSkyGrey = 0.7864F;  // BT.601 luma of kSkyRgb

Status check_supported(const CameraRequest& request) {
  const auto unsupported = [](const char* what) {
    return Error{ErrorCode::kUnsupported, std::string("the OpenGL renderer has no ") + what};
  };
  if (!request.camera.distortion().none()) return unsupported("lens distortion");
  if (request.exposure_ns != 0 && !request.T_world_camera.still()) return unsupported("blur");
  if (request.readout_ns != 0 && !request.T_world_camera.still()) {
    return unsupported("rolling shutter");
  }
  if (is_linear(request.format)) return unsupported("linear radiance");
  return {};
}

class EglRenderer final : public Renderer {
 public:
  EglRenderer(std::unique_ptr<EglContext> context,
              GroundPass ground,
              ScenePass scene,
              std::shared_ptr<const terrain::TileSource> tiles,
              const RendererOptions& options)
      : context_(std::move(context)),
        tiles_(std::move(tiles)),
        patches_(tiles_),
        textures_(tiles_, options.tile_cache_bytes),
        ground_(std::move(ground)),
        scene_(std::move(scene)) {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glDisable(GL_DITHER);
  }

  ~EglRenderer() override {
    // GL names are deleted by the members' destructors, in this context.
    (void)context_->make_current();
  }
  EglRenderer(const EglRenderer&) = delete;
  EglRenderer& operator=(const EglRenderer&) = delete;

  using Renderer::render_camera;
  using Renderer::render_depth;

  Result<CameraFrame> render_camera(const CameraRequest& request) override {
    if (Status s = check_camera_request(*tiles_, request); !s) return s.error();
    if (Status s = check_supported(request); !s) return s.error();
    if (Status s = context_->make_current(); !s) return s.error();
    const PinholeCamera& camera = request.camera.pinhole();
    const Pose T_world_camera = request.T_world_camera.at(request.t_ns);
    const PixelFormat format = request.format;
    const TargetFormat target_format =
        format == PixelFormat::kGrey8 ? TargetFormat::kGrey8 : TargetFormat::kRgba8;
    const Result<RenderTarget*> target = target_for(camera, target_format);
    if (!target.ok()) return target.error();

    const View view = View::from(camera, T_world_camera);
    const GroundMesh mesh = build_ground_mesh(patches_, view, {});
    (*target)->bind();
    if (format == PixelFormat::kGrey8) {
      glClearColor(kSkyGrey, 0.0F, 0.0F, 1.0F);
    } else {
      glClearColor(kSkyRgb[0], kSkyRgb[1], kSkyRgb[2], 1.0F);
    }
    glClear(GL_COLOR_BUFFER_BIT);
    prepare_depth_test(mesh.needs_depth_test);
    const Status drawn = ground_.draw(mesh, camera, textures_, format, GroundPass::Output::kColour);
    if (!drawn) return drawn.error();

    CameraFrame frame;
    frame.t_ns = request.t_ns;
    frame.T_world_camera = T_world_camera;
    frame.camera = request.camera;
    const FrameStatistics statistics =
        measure_frame(mesh, view, *tiles_, [&](const terrain::TileId& tile, double u, double v) {
          return textures_.has_imagery(tile, format, u, v);
        });
    frame.texels_per_pixel_min = statistics.texels_per_pixel_min;
    frame.texels_per_pixel_median = statistics.texels_per_pixel_median;
    frame.void_fraction = statistics.void_fraction;
    frame.axis_depth_m = statistics.axis_depth_m;
    (*target)->read(frame.image);
    textures_.end_view();
    return frame;
  }

  Result<DepthImage> render_depth(const CameraRequest& request) override {
    if (Status s = check_camera_request(*tiles_, request); !s) return s.error();
    if (Status s = check_supported(request); !s) return s.error();
    if (Status s = context_->make_current(); !s) return s.error();
    const PinholeCamera& camera = request.camera.pinhole();
    const Pose T_world_camera = request.T_world_camera.at(request.t_ns);
    const Result<RenderTarget*> target = target_for(camera, TargetFormat::kDepthM);
    if (!target.ok()) return target.error();
    const GroundMesh mesh = build_ground_mesh(patches_, View::from(camera, T_world_camera), {});
    (*target)->bind();
    glClearColor(std::numeric_limits<float>::infinity(), 0.0F, 0.0F, 0.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    prepare_depth_test(mesh.needs_depth_test);
    const Status drawn =
        ground_.draw(mesh, camera, textures_, PixelFormat::kGrey8, GroundPass::Output::kDepthM);
    if (!drawn) return drawn.error();
    DepthImage depth;
    (*target)->read(depth);
    return depth;
  }

  Result<Image> render_scene(const SceneView& view, const SceneContent& content) override {
    const Result<PinholeCamera> camera = camera_of(view);
    if (!camera.ok()) return camera.error();
    if (Status s = context_->make_current(); !s) return s.error();
    return scene_.draw(
        content, View::from(*camera, view.T_world_camera), *tiles_, patches_, ground_, textures_);
  }

  [[nodiscard]] RendererInfo info() const override {
    (void)context_->make_current();
    return context_->info();
  }

 private:
  static void prepare_depth_test(bool needed) {
    if (!needed) {
      glDisable(GL_DEPTH_TEST);
      return;
    }
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    glClearDepth(0.0);
    glClear(GL_DEPTH_BUFFER_BIT);
  }

  /// The target of a format, made anew when the image's size changes.
  Result<RenderTarget*> target_for(const PinholeCamera& camera, TargetFormat format) {
    auto found = targets_.find(format);
    if (found == targets_.end() || !found->second.fits(camera.width_px, camera.height_px)) {
      Result<RenderTarget> target =
          RenderTarget::create(camera.width_px, camera.height_px, format, 0);
      if (!target.ok()) return target.error();
      found = targets_.insert_or_assign(format, std::move(*target)).first;
    }
    return &found->second;
  }

  std::unique_ptr<EglContext> context_;  // first: goes last
  std::shared_ptr<const terrain::TileSource> tiles_;
  GroundPatches patches_;
  TileTextures textures_;
  GroundPass ground_;
  ScenePass scene_;
  std::map<TargetFormat, RenderTarget> targets_;
};

}  // namespace
}  // namespace egl

Result<std::unique_ptr<Renderer>> create_egl_renderer(
    std::shared_ptr<const terrain::TileSource> tiles, const RendererOptions& options) {
  Result<std::unique_ptr<egl::EglContext>> context = egl::EglContext::create();
  if (!context.ok()) return context.error();
  Result<egl::GroundPass> ground = egl::GroundPass::create();
  if (!ground.ok()) return ground.error();
  Result<egl::ScenePass> scene = egl::ScenePass::create();
  if (!scene.ok()) return scene.error();
  return std::unique_ptr<Renderer>(std::make_unique<egl::EglRenderer>(
      std::move(*context), std::move(*ground), std::move(*scene), std::move(tiles), options));
}

Result<RendererInfo> probe_egl() {
  const Result<std::unique_ptr<egl::EglContext>> context = egl::EglContext::create();
  if (!context.ok()) return context.error();
  return (*context)->info();
}

}  // namespace overfly::renderer
