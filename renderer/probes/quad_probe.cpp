#include <cmath>
#include <utility>
#include <vector>

#include "core/motion/pose.hpp"
#include "renderer/egl/egl_context.hpp"
#include "renderer/egl/gl_objects.hpp"
#include "renderer/egl/gl_program.hpp"
#include "renderer/egl/pixel_ring.hpp"
#include "renderer/egl/render_target.hpp"
#include "renderer/egl/texture_upload.hpp"
#include "renderer/probes/bench_probe.hpp"
#include "renderer/tiles/tile_pixels.hpp"

namespace overfly::renderer {

namespace egl {
namespace {

constexpr int kTextureTexels = 4096;

constexpr const char* kQuadVertexSource = R"(#version 330 core
uniform mat2 uv_from_pixel;
uniform vec2 size_px;
out vec2 uv;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  uv = vec2(0.5) + uv_from_pixel * ((corner - 0.5) * size_px);
  gl_Position = vec4(2.0 * corner - 1.0, 0.0, 1.0);
}
)";

constexpr const char* kQuadFragmentSource = R"(#version 330 core
uniform sampler2D image;
in vec2 uv;
out vec4 colour;
void main() { colour = texture(image, uv); }
)";

GlTexture make_texture() {
  Image texels(kTextureTexels, kTextureTexels, 1);
  std::uint32_t state = 1;
  for (std::uint8_t& texel : texels.data) {
    state = state * 1664525U + 1013904223U;
    texel = static_cast<std::uint8_t>(state >> 24U);
  }
  return upload_texture(mip_chain(std::move(texels)));
}

class EglQuadProbe final : public QuadProbe {
 public:
  EglQuadProbe(std::unique_ptr<EglContext> context, RenderTarget target, GlProgram program)
      : context_(std::move(context)),
        target_(std::move(target)),
        program_(std::move(program)),
        texture_(make_texture()),
        vertex_array_(GlVertexArray::make()) {
    // 2^0.5 texels per pixel: level of detail 0.5.
    const double scale = std::sqrt(2.0) / kTextureTexels;
    const double angle_rad = rad_from_deg(30.0);
    const auto c = static_cast<float>(scale * std::cos(angle_rad));
    const auto s = static_cast<float>(scale * std::sin(angle_rad));
    const float uv_from_pixel[4] = {c, s, -s, c};
    program_.use();
    glUniformMatrix2fv(program_.uniform("uv_from_pixel"), 1, GL_FALSE, uv_from_pixel);
    glUniform2f(program_.uniform("size_px"), kProbeWidthPx, kProbeHeightPx);
  }
  ~EglQuadProbe() override { (void)context_->make_current(); }
  EglQuadProbe(const EglQuadProbe&) = delete;
  EglQuadProbe& operator=(const EglQuadProbe&) = delete;

  Status draw() override {
    if (Status status = draw_only(); !status) return status;
    target_.read(image_);
    return {};
  }

  Status draw_only() override {
    if (Status status = context_->make_current(); !status) return status;
    target_.bind();
    glDisable(GL_DEPTH_TEST);
    program_.use();
    glBindVertexArray(vertex_array_.name());
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    return {};
  }

  Status wait() override {
    if (Status status = context_->make_current(); !status) return status;
    glFinish();
    return {};
  }

  Status read() override {
    if (Status status = context_->make_current(); !status) return status;
    target_.read(image_);
    return {};
  }

  Status read_piped() override {
    if (Status status = context_->make_current(); !status) return status;
    if (ring_.full()) {
      if (Status status = ring_.pop(image_); !status) return status;
    }
    ring_.push(target_);
    return {};
  }

  [[nodiscard]] RendererInfo info() const override {
    (void)context_->make_current();
    return context_->info();
  }

 private:
  std::unique_ptr<EglContext> context_;  // declared first, so that it is destroyed last
  RenderTarget target_;
  GlProgram program_;
  GlTexture texture_;
  GlVertexArray vertex_array_;
  PixelRing ring_{3};
  Image image_;
};

}  // namespace
}  // namespace egl

Result<std::unique_ptr<QuadProbe>> QuadProbe::create(const std::string& device) {
  Result<std::unique_ptr<egl::EglContext>> context = egl::EglContext::create(device);
  if (!context.ok()) return context.error();
  Result<egl::RenderTarget> target =
      egl::RenderTarget::create(kProbeWidthPx, kProbeHeightPx, egl::TargetFormat::kGrey8, 0);
  if (!target.ok()) return target.error();
  Result<egl::GlProgram> program =
      egl::GlProgram::link(egl::kQuadVertexSource, egl::kQuadFragmentSource);
  if (!program.ok()) return program.error();
  return std::unique_ptr<QuadProbe>(std::make_unique<egl::EglQuadProbe>(
      std::move(*context), std::move(*target), std::move(*program)));
}

}  // namespace overfly::renderer
