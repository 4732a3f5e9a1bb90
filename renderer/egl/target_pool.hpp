// A pool of off-screen images by size and format.
#pragma once

#include <list>

#include "renderer/egl/render_target.hpp"

namespace overfly::renderer::egl {

class TargetPool {
 public:
  /// Valid until the next call. Errors: as RenderTarget::create.
  Result<RenderTarget*> get(int width_px, int height_px, TargetFormat format);

 private:
  struct Entry {
    TargetFormat format;
    RenderTarget target;
  };
  std::list<Entry> entries_;  // last used first
};

}  // namespace overfly::renderer::egl
