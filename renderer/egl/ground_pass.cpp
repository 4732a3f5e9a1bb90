#include "renderer/egl/ground_pass.hpp"

#include <vector>

namespace overfly::renderer::egl {

namespace {

constexpr const char* kVertexSource = R"(#version 330 core
uniform vec4 projection;
uniform float near;
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 texel;
out vec2 uv;
out float depth_m;
out float clarity;
void main() {
  uv = texel;
  depth_m = position.z;
  // By vertex: at the horizon's slivers a sample outside its triangle would extrapolate depth.
  clarity = exp(-max(position.z, 0.0) / 9000.0);
  gl_Position = vec4(projection.xy * position.xy + projection.zw * position.z, near, position.z);
}
)";

constexpr const char* kColourSource = R"(#version 330 core
uniform sampler2D tile;
in vec2 uv;
out vec4 colour;
void main() { colour = texture(tile, uv); }
)";

constexpr const char* kHazySource = R"(#version 330 core
uniform sampler2D tile;
uniform bool textured;
uniform vec3 haze;
in vec2 uv;
in float clarity;
out vec4 colour;
const vec3 bare = vec3(0.44, 0.46, 0.39);
void main() {
  vec3 ground = bare;
  if (textured) {
    vec4 texel = texture(tile, uv);
    ground = mix(bare, texel.rgb, texel.a);
  }
  colour = vec4(mix(haze, ground, clamp(clarity, 0.0, 1.0)), 1.0);
}
)";

constexpr const char* kDepthSource = R"(#version 330 core
in float depth_m;
out float written_m;
void main() { written_m = depth_m; }
)";

}  // namespace

void set_projection(const GlProgram& program, const PinholeCamera& camera) {
  glUniform4f(program.uniform("projection"),
              static_cast<float>(2.0 * camera.fx_px / camera.width_px),
              static_cast<float>(2.0 * camera.fy_px / camera.height_px),
              static_cast<float>((2.0 * camera.cx_px + 1.0) / camera.width_px - 1.0),
              static_cast<float>((2.0 * camera.cy_px + 1.0) / camera.height_px - 1.0));
  glUniform1f(program.uniform("near"), kNearM);
}

Result<GroundPass> GroundPass::create() {
  Result<GlProgram> colour = GlProgram::link(kVertexSource, kColourSource);
  if (!colour.ok()) return colour.error();
  Result<GlProgram> hazy = GlProgram::link(kVertexSource, kHazySource);
  if (!hazy.ok()) return hazy.error();
  Result<GlProgram> depth = GlProgram::link(kVertexSource, kDepthSource);
  if (!depth.ok()) return depth.error();
  return GroundPass(std::move(*colour), std::move(*hazy), std::move(*depth));
}

GroundPass::GroundPass(GlProgram colour, GlProgram hazy, GlProgram depth)
    : colour_(std::move(colour)),
      hazy_(std::move(hazy)),
      depth_(std::move(depth)),
      vertex_array_(GlVertexArray::make()),
      vertices_(GlBuffer::make()),
      indices_(GlBuffer::make()) {
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(GroundVertex), nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(
      1, 2, GL_FLOAT, GL_FALSE, sizeof(GroundVertex), buffer_offset(offsetof(GroundVertex, u)));
}

void GroundPass::upload(const GroundMesh& mesh) {
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glBufferData(GL_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(GroundVertex)),
               mesh.vertices.data(),
               GL_STREAM_DRAW);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)),
               mesh.indices.data(),
               GL_STREAM_DRAW);
}

Status GroundPass::find_textures(const GroundMesh& mesh,
                                 TileTextures& textures,
                                 PixelFormat format) {
  names_.clear();
  for (const GroundBatch& batch : mesh.batches) {
    if (!batch.textured) {
      names_.push_back(textures.void_texture(format));
      continue;
    }
    const Result<GLuint> texture = textures.texture(batch.texture, format);
    if (!texture.ok()) return texture.error();
    names_.push_back(*texture);
  }
  return {};
}

Status GroundPass::draw(const GroundMesh& mesh,
                        const PinholeCamera& camera,
                        TileTextures& textures,
                        PixelFormat format,
                        Output output) {
  if (output != Output::kDepthM) {
    if (Status status = find_textures(mesh, textures, format); !status) return status;
  }
  const GlProgram& program = output == Output::kColour       ? colour_
                             : output == Output::kHazyColour ? hazy_
                                                             : depth_;
  program.use();
  set_projection(program, camera);
  glUniform3fv(program.uniform("haze"), 1, kHazeRgb);
  const GLint textured = program.uniform("textured");
  upload(mesh);
  for (std::size_t i = 0; i < mesh.batches.size(); ++i) {
    const GroundBatch& batch = mesh.batches[i];
    if (output != Output::kDepthM) glBindTexture(GL_TEXTURE_2D, names_[i]);
    glUniform1i(textured, batch.textured ? 1 : 0);
    glDrawElements(GL_TRIANGLES,
                   static_cast<GLsizei>(batch.index_count),
                   GL_UNSIGNED_INT,
                   buffer_offset(batch.first_index * sizeof(std::uint32_t)));
  }
  return {};
}

}  // namespace overfly::renderer::egl
