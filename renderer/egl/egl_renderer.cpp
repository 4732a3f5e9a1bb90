#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "renderer/camera/view_ahead.hpp"
#include "renderer/camera_pipeline.hpp"
#include "renderer/egl/camera_pass.hpp"
#include "renderer/egl/camera_queue.hpp"
#include "renderer/egl/egl_context.hpp"
#include "renderer/egl/ground_pass.hpp"
#include "renderer/egl/scene_pass.hpp"
#include "renderer/egl/tile_textures.hpp"
#include "renderer/renderer.hpp"
#include "renderer/request_check.hpp"
#include "renderer/worker_pool.hpp"

namespace overfly::renderer {

namespace egl {

class EglRenderer final : public Renderer {
 public:
  EglRenderer(std::unique_ptr<EglContext> context,
              GroundPass ground,
              ScenePass scene,
              const std::shared_ptr<TileStore>& store,
              const std::shared_ptr<GroundPatchStore>& patches,
              std::size_t texture_bytes,
              std::size_t in_flight,
              int threads)
      : context_(std::move(context)),
        tiles_(store->tiles()),
        workers_(threads),
        patches_(patches, &workers_),
        textures_(store, texture_bytes),
        ground_(std::move(ground)),
        scene_(std::move(scene)),
        camera_(patches_, ground_, textures_),
        ahead_(store, patches),
        queue_(in_flight) {
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
    if (Status s = check_camera_request(tiles_, request); !s) return s.error();
    if (Status s = context_->make_current(); !s) return s.error();
    ahead_.expect(request);
    CameraFrame frame = frame_of(request);
    if (Status s = camera_.draw(request, frame); !s) return s.error();
    if (Status s = tiles_.status(); !s) return s.error();
    return frame;
  }

  /// As CameraPipeline::begin.
  Status begin(const CameraRequest& request) {
    if (queue_.full())
      return Error{ErrorCode::kConflict, "the maximum number of images is in flight"};
    if (Status s = check_camera_request(tiles_, request); !s) return s;
    if (Status s = context_->make_current(); !s) return s;
    ahead_.expect(request);
    return queue_.begin(camera_, request, frame_of(request));
  }

  /// As CameraPipeline::finish.
  Result<CameraFrame> finish() {
    if (Status s = context_->make_current(); !s) return s.error();
    Result<CameraFrame> frame = queue_.finish();
    if (!frame.ok()) return frame;
    if (Status s = tiles_.status(); !s) return s.error();
    return frame;
  }

  Result<DepthImage> render_depth(const CameraRequest& request) override {
    if (Status s = check_camera_request(tiles_, request); !s) return s.error();
    if (Status s = context_->make_current(); !s) return s.error();
    Result<DepthImage> depth = camera_.depth(request);
    if (Status s = tiles_.status(); !s) return s.error();
    return depth;
  }

  Result<Image> render_scene(const SceneView& view, const SceneContent& content) override {
    const Result<PinholeCamera> camera = camera_of(view);
    if (!camera.ok()) return camera.error();
    if (Status s = context_->make_current(); !s) return s.error();
    return scene_.draw(content,
                       View::from(*camera, view.T_world_camera),
                       tiles_,
                       patches_,
                       ground_,
                       textures_,
                       view.tile_wait_ns);
  }

  void expect_scenes(const std::vector<SceneView>& scenes) override {
    std::vector<View> views;
    views.reserve(scenes.size());
    for (const SceneView& scene : scenes) {
      const Result<PinholeCamera> camera = camera_of(scene);
      if (camera) views.push_back(View::from(*camera, scene.T_world_camera));
    }
    ahead_.expect_later(std::move(views));
  }

  [[nodiscard]] RendererInfo info() const override {
    (void)context_->make_current();
    return context_->info();
  }

 private:
  /// The metadata of a frame that is known before drawing.
  static CameraFrame frame_of(const CameraRequest& request) {
    CameraFrame frame;
    frame.t_ns = request.t_ns;
    frame.T_world_camera = request.T_world_camera.at(request.t_ns);
    frame.camera = request.camera;
    return frame;
  }

  std::unique_ptr<EglContext> context_;  // declared first, so that it is destroyed last
  const terrain::TileSource& tiles_;     // of the store in textures_
  WorkerPool workers_;
  GroundPatches patches_;
  TileTextures textures_;
  GroundPass ground_;
  ScenePass scene_;
  CameraPass camera_;
  ViewAhead ahead_;
  CameraQueue queue_;
};

namespace {

Result<std::unique_ptr<EglRenderer>> create(std::shared_ptr<const terrain::TileSource> tiles,
                                            const RendererOptions& options,
                                            int in_flight) {
  Result<std::unique_ptr<EglContext>> context = EglContext::create(options.device);
  if (!context.ok()) return context.error();
  Result<GroundPass> ground = GroundPass::create();
  if (!ground.ok()) return ground.error();
  Result<ScenePass> scene = ScenePass::create();
  if (!scene.ok()) return scene.error();
  std::shared_ptr<TileStore> store = options.tile_store;
  if (store == nullptr) {
    store = std::make_shared<TileStore>(tiles, TileStoreOptions{options.tile_cache_bytes, 1});
  }
  return std::make_unique<EglRenderer>(std::move(*context),
                                       std::move(*ground),
                                       std::move(*scene),
                                       std::move(store),
                                       std::make_shared<GroundPatchStore>(std::move(tiles)),
                                       options.tile_cache_bytes,
                                       static_cast<std::size_t>(in_flight),
                                       options.threads);
}

}  // namespace
}  // namespace egl

Result<std::unique_ptr<Renderer>> create_egl_renderer(
    std::shared_ptr<const terrain::TileSource> tiles, const RendererOptions& options) {
  Result<std::unique_ptr<egl::EglRenderer>> renderer = egl::create(std::move(tiles), options, 1);
  if (!renderer.ok()) return renderer.error();
  return std::unique_ptr<Renderer>(std::move(*renderer));
}

CameraPipeline::CameraPipeline(std::unique_ptr<egl::EglRenderer> renderer)
    : renderer_(std::move(renderer)) {}

CameraPipeline::~CameraPipeline() = default;
CameraPipeline::CameraPipeline(CameraPipeline&&) noexcept = default;
CameraPipeline& CameraPipeline::operator=(CameraPipeline&&) noexcept = default;

Status CameraPipeline::begin(const CameraRequest& request) { return renderer_->begin(request); }

Result<CameraFrame> CameraPipeline::finish() { return renderer_->finish(); }

Result<CameraPipeline> CameraPipeline::create(std::shared_ptr<const terrain::TileSource> tiles,
                                              const RendererOptions& options,
                                              int in_flight) {
  if (in_flight < 1 || in_flight > 16) {
    return Error{ErrorCode::kInvalidArgument,
                 "in_flight is " + std::to_string(in_flight) + ", must be in [1, 16]"};
  }
  Result<std::unique_ptr<egl::EglRenderer>> renderer =
      egl::create(std::move(tiles), options, in_flight);
  if (!renderer.ok()) return renderer.error();
  return CameraPipeline(std::move(*renderer));
}

Result<RendererInfo> probe_egl(const std::string& device) {
  const Result<std::unique_ptr<egl::EglContext>> context = egl::EglContext::create(device);
  if (!context.ok()) return context.error();
  return (*context)->info();
}

std::vector<GraphicsDevice> list_graphics_devices() { return egl::list_devices(); }

}  // namespace overfly::renderer
