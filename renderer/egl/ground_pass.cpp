#include "renderer/egl/ground_pass.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace overfly::renderer::egl {

namespace {

constexpr const char* kGroundVertexSource = R"(#version 330 core
uniform vec4 projection;
uniform float near;
uniform vec3 window;
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 texel;
out vec2 uv;
out vec3 place_m;
out float depth_m;
out float clarity;
void main() {
  uv = texel * window.x + window.yz;
  place_m = position;
  depth_m = position.z;
  // Per vertex: in slivers at the horizon a sample outside its triangle would extrapolate depth.
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

constexpr const char* kAirySource = R"(#version 330 core
uniform sampler2D tile;
uniform float extinction;
uniform vec3 airlight;
uniform vec4 lod_bias;
uniform vec2 size_px;
in vec2 uv;
in vec3 place_m;
out vec4 colour;
void main() {
  vec2 at = gl_FragCoord.xy / size_px;
  float bias = mix(mix(lod_bias.x, lod_bias.y, at.x), mix(lod_bias.z, lod_bias.w, at.x), at.y);
  float clear = exp(-extinction * length(place_m));
  colour = vec4(mix(airlight, texture(tile, uv, bias).rgb, clear), 1.0);
}
)";

constexpr const char* kHazyVersion = "#version 330 core\n";

constexpr const char* kNoProjectionSource = R"(
bool seen_by_camera(vec3 place, out vec3 seen) { return false; }
)";

constexpr const char* kHazySource = R"(
uniform sampler2D tile;
uniform bool textured;
uniform vec3 haze;
in vec2 uv;
in vec3 place_m;
in float clarity;
out vec4 colour;
const vec3 bare = vec3(0.44, 0.46, 0.39);
void main() {
  vec3 ground = bare;
  vec3 seen;
  if (seen_by_camera(place_m, seen)) {
    ground = seen;
  } else if (textured) {
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
  Result<GlProgram> colour = GlProgram::link(kGroundVertexSource, kColourSource);
  if (!colour.ok()) return colour.error();
  Result<GlProgram> airy = GlProgram::link(kGroundVertexSource, kAirySource);
  if (!airy.ok()) return airy.error();
  const std::string plain = std::string(kHazyVersion) + kNoProjectionSource + kHazySource;
  Result<GlProgram> hazy = GlProgram::link(kGroundVertexSource, plain.c_str());
  if (!hazy.ok()) return hazy.error();
  const std::string with_image = std::string(kProjectionSource) + kHazySource;
  Result<GlProgram> projected = GlProgram::link(kGroundVertexSource, with_image.c_str());
  if (!projected.ok()) return projected.error();
  Result<GlProgram> depth = GlProgram::link(kGroundVertexSource, kDepthSource);
  if (!depth.ok()) return depth.error();
  return GroundPass(std::move(*colour),
                    std::move(*airy),
                    std::move(*hazy),
                    std::move(*projected),
                    std::move(*depth));
}

GroundPass::GroundPass(
    GlProgram colour, GlProgram airy, GlProgram hazy, GlProgram projected, GlProgram depth)
    : colour_(std::move(colour)),
      airy_(std::move(airy)),
      hazy_(std::move(hazy)),
      projected_(std::move(projected)),
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
                                 const GroundLook& look) {
  tiles_.clear();
  if (look.tile_wait_ns > 0) {
    std::vector<terrain::TileId> ids;
    for (const GroundBatch& batch : mesh.batches) {
      if (batch.textured) ids.push_back(batch.texture);
    }
    textures.load(ids, look.format, look.tile_wait_ns);
  }
  for (const GroundBatch& batch : mesh.batches) {
    if (!batch.textured) {
      tiles_.push_back({textures.void_texture(look.format), 1.0F, {}});
      continue;
    }
    const Result<DrawnTile> tile =
        textures.texture(batch.texture, look.format, look.tile_wait_ns == kForAllTiles);
    if (!tile.ok()) return tile.error();
    tiles_.push_back(*tile);
  }
  return {};
}

const GlProgram& GroundPass::use_program(const GroundLook& look, const PinholeCamera& camera) {
  const auto& bias = look.lod_bias;
  const bool plain = look.extinction_per_m == 0.0 &&
                     std::all_of(bias.begin(), bias.end(), [](float b) { return b == 0.0F; });
  const GlProgram* program = plain ? &colour_ : &airy_;
  if (look.output == GroundLook::Output::kHazyColour) {
    program = look.projection == nullptr ? &hazy_ : &projected_;
  }
  if (look.output == GroundLook::Output::kDepthM) program = &depth_;
  program->use();
  set_projection(*program, camera);
  if (program == &projected_) look.projection->use(*program);
  glUniform3fv(program->uniform("haze"), 1, kHazeRgb);
  glUniform1f(program->uniform("extinction"), static_cast<float>(look.extinction_per_m));
  glUniform3fv(program->uniform("airlight"), 1, look.airlight.data());
  glUniform4fv(program->uniform("lod_bias"), 1, bias.data());
  glUniform2f(program->uniform("size_px"),
              static_cast<float>(camera.width_px),
              static_cast<float>(camera.height_px));
  glUniform3f(program->uniform("window"), 1.0F, 0.0F, 0.0F);
  return *program;
}

Status GroundPass::draw(const GroundMesh& mesh,
                        const PinholeCamera& camera,
                        TileTextures& textures,
                        const GroundLook& look) {
  const bool coloured = look.output != GroundLook::Output::kDepthM;
  if (coloured) {
    if (Status status = find_textures(mesh, textures, look); !status) return status;
  }
  const GlProgram& program = use_program(look, camera);
  const GLint textured = program.uniform("textured");
  const GLint window = program.uniform("window");
  upload(mesh);
  for (std::size_t i = 0; i < mesh.batches.size(); ++i) {
    const GroundBatch& batch = mesh.batches[i];
    if (coloured) {
      const DrawnTile& tile = tiles_[i];
      glBindTexture(GL_TEXTURE_2D, tile.texture);
      glUniform3f(window, tile.scale, tile.offset[0], tile.offset[1]);
    }
    glUniform1i(textured, batch.textured ? 1 : 0);
    glDrawElements(GL_TRIANGLES,
                   static_cast<GLsizei>(batch.index_count),
                   GL_UNSIGNED_INT,
                   buffer_offset(batch.first_index * sizeof(std::uint32_t)));
  }
  return {};
}

}  // namespace overfly::renderer::egl
