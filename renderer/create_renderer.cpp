#include <string>
#include <utility>

#include "renderer/renderer.hpp"
#include "renderer/tiles/tile_store.hpp"

namespace overfly::renderer {

namespace {

/// Draws the camera by casting rays, and scene views by OpenGL if it works.
class CombinedRenderer final : public Renderer {
 public:
  /// @param scenes  null if OpenGL is to be started at the first scene view
  CombinedRenderer(std::shared_ptr<const terrain::TileSource> tiles,
                   const RendererOptions& options,
                   Result<std::unique_ptr<Renderer>> scenes,
                   std::string note)
      : tiles_(std::move(tiles)),
        options_(options),
        camera_(create_raycast_renderer(tiles_, options_)),
        scenes_(std::move(scenes)),
        note_(std::move(note)) {}

  using Renderer::render_camera;
  using Renderer::render_depth;

  Result<CameraFrame> render_camera(const CameraRequest& request) override {
    return camera_->render_camera(request);
  }
  Result<DepthImage> render_depth(const CameraRequest& request) override {
    return camera_->render_depth(request);
  }
  Result<Image> render_scene(const SceneView& view, const SceneContent& content) override {
    if (scenes_.ok() && *scenes_ == nullptr) scenes_ = create_egl_renderer(tiles_, options_);
    if (!scenes_.ok()) return scenes_.error().in("scene views need OpenGL");
    return (*scenes_)->render_scene(view, content);
  }
  void expect_scenes(const std::vector<SceneView>& views) override {
    if (scenes_.ok() && *scenes_ != nullptr) (*scenes_)->expect_scenes(views);
  }
  [[nodiscard]] RendererInfo info() const override {
    RendererInfo info = camera_->info();
    info.camera_note = note_;
    if (scenes_.ok() && *scenes_ != nullptr) {
      const RendererInfo scenes = (*scenes_)->info();
      info.gl_version = scenes.gl_version;
      info.device_note = scenes.device_note;
      info.device += "; scene views: " + scenes.device;
    }
    return info;
  }

 private:
  std::shared_ptr<const terrain::TileSource> tiles_;
  RendererOptions options_;
  std::unique_ptr<Renderer> camera_;
  Result<std::unique_ptr<Renderer>> scenes_;
  std::string note_;
};

}  // namespace

Result<std::unique_ptr<Renderer>> create_renderer(std::shared_ptr<const terrain::TileSource> tiles,
                                                  const RendererOptions& options) {
  if (options.camera_backend == CameraBackend::kEgl) return create_egl_renderer(tiles, options);
  RendererOptions shared = options;
  if (shared.tile_store == nullptr) {
    TileStoreOptions store;
    store.budget_bytes = options.tile_cache_bytes;
    shared.tile_store = std::make_shared<TileStore>(tiles, store);
  }
  Result<std::unique_ptr<Renderer>> scenes = std::unique_ptr<Renderer>();
  std::string note = "the ray-caster was requested";
  if (options.camera_backend == CameraBackend::kAuto) {
    scenes = create_egl_renderer(tiles, shared);
    if (scenes.ok() && !(*scenes)->info().software) return scenes;
    note = scenes.ok() ? "OpenGL has no GPU here (" + (*scenes)->info().device +
                             "): the ray-caster is faster except on hills towards the horizon, and "
                             "equally accurate"
                       : "OpenGL does not work here: " + scenes.error().message;
  }
  return std::unique_ptr<Renderer>(
      std::make_unique<CombinedRenderer>(std::move(tiles), shared, std::move(scenes), note));
}

}  // namespace overfly::renderer
