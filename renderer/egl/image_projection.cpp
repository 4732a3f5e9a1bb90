#include "renderer/egl/image_projection.hpp"

#include <algorithm>
#include <array>

namespace overfly::renderer::egl {
namespace {

constexpr GLuint kImageUnit = 1;
constexpr GLuint kDepthUnit = 2;

void set_filters(GLint minify, GLint magnify) {
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, minify);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, magnify);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

GlTexture image_texture(const Image& image) {
  GlTexture texture = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const bool grey = image.channels == 1;
  glTexImage2D(GL_TEXTURE_2D,
               0,
               grey ? GL_R8 : GL_RGB8,
               image.width_px,
               image.height_px,
               0,
               grey ? GL_RED : GL_RGB,
               GL_UNSIGNED_BYTE,
               image.data.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  set_filters(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
  if (grey) {
    constexpr std::array<GLint, 4> kGrey = {GL_RED, GL_RED, GL_RED, GL_ONE};
    glTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_RGBA, kGrey.data());
  }
  return texture;
}

GlTexture depth_texture(const DepthImage& depth) {
  GlTexture texture = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexImage2D(GL_TEXTURE_2D,
               0,
               GL_R32F,
               depth.width_px,
               depth.height_px,
               0,
               GL_RED,
               GL_FLOAT,
               depth.data.data());
  set_filters(GL_NEAREST, GL_NEAREST);
  return texture;
}

/// T_seen_view of a pose of the camera that sees.
void set_transform(const Pose& T_world_camera,
                   const View& view,
                   Eigen::Matrix3f* R_seen_view,
                   Eigen::Vector3f* p_seen_view) {
  const Eigen::Matrix3d R_seen_world = T_world_camera.rotation.conjugate().toRotationMatrix();
  *R_seen_view = (R_seen_world * view.R_camera_world.transpose()).cast<float>();
  *p_seen_view = (R_seen_world * (view.position_world - T_world_camera.translation)).cast<float>();
}

}  // namespace

// The projection is that of CameraModel::project. With a rolling shutter a place is seen by the row
// that looks at it while that row is exposed: found by iteration, which converges at the ratio of
// the image's motion during the readout to its height.
const char* const kProjectionSource = R"(#version 330 core
uniform sampler2D seen_image;
uniform sampler2D seen_depth;
uniform mat3 R_first, R_last;
uniform vec3 p_first, p_last;
uniform vec4 intrinsics;
uniform vec2 image_size;
uniform int lens;
uniform float lens_k[5];
uniform float max_radius;

vec2 distorted(vec2 m) {
  float r = length(m);
  if (lens == 1) {
    float r2 = r * r;
    float radial = 1.0 + r2 * (lens_k[0] + r2 * (lens_k[1] + r2 * lens_k[4]));
    float p1 = lens_k[2], p2 = lens_k[3];
    return m * radial + vec2(2.0 * p1 * m.x * m.y + p2 * (r2 + 2.0 * m.x * m.x),
                             p1 * (r2 + 2.0 * m.y * m.y) + 2.0 * p2 * m.x * m.y);
  }
  if (lens == 2) {
    if (r < 1e-6) return m;
    float theta = atan(r), t2 = theta * theta;
    float angle = theta * (1.0 + t2 * (lens_k[0] + t2 * (lens_k[1] + t2 * (lens_k[2] + t2 * lens_k[3]))));
    return m * (angle / r);
  }
  if (lens == 3) {
    if (abs(lens_k[0]) < 1e-6) return m;
    float a = 2.0 * tan(0.5 * lens_k[0]);
    return m * (r < 1e-6 ? a / lens_k[0] : atan(a * r) / (lens_k[0] * r));
  }
  return m;
}

bool seen_by_camera(vec3 place, out vec3 seen) {
  float row = 0.5;
  vec2 pixel;
  vec3 p;
  for (int i = 0; i < 4; ++i) {
    p = mix(R_first * place + p_first, R_last * place + p_last, row);
    if (p.z <= 0.0) return false;
    vec2 ideal = p.xy / p.z;
    if (length(ideal) > max_radius) return false;
    pixel = intrinsics.xy * distorted(ideal) + intrinsics.zw;
    row = clamp(pixel.y / max(image_size.y - 1.0, 1.0), 0.0, 1.0);
  }
  vec2 at = (pixel + 0.5) / image_size;
  if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) return false;
  // Hidden if clearly farther than what the camera sees there.
  if (p.z > 1.02 * textureLod(seen_depth, at, 0.0).r + 1.0) return false;
  seen = texture(seen_image, at).rgb;
  return true;
}
)";

void ImageProjection::upload(const SceneContent::Projection& projection) {
  if (image_ != projection.image) {
    image_texture_ = image_texture(*projection.image);
    image_ = projection.image;
  }
  if (depth_ != projection.depth) {
    depth_texture_ = depth_texture(*projection.depth);
    depth_ = projection.depth;
  }
}

void ImageProjection::prepare(const SceneContent::Projection& projection, const View& view) {
  upload(projection);
  camera_ = projection.camera;
  set_transform(projection.T_world_camera_first, view, &R_first_, &p_first_);
  set_transform(projection.T_world_camera_last, view, &R_last_, &p_last_);
}

void ImageProjection::use(const GlProgram& program) const {
  const PinholeCamera& pinhole = camera_.pinhole();
  const Distortion& distortion = camera_.distortion();
  glUniformMatrix3fv(program.uniform("R_first"), 1, GL_FALSE, R_first_.data());
  glUniformMatrix3fv(program.uniform("R_last"), 1, GL_FALSE, R_last_.data());
  glUniform3fv(program.uniform("p_first"), 1, p_first_.data());
  glUniform3fv(program.uniform("p_last"), 1, p_last_.data());
  glUniform4f(program.uniform("intrinsics"),
              static_cast<float>(pinhole.fx_px),
              static_cast<float>(pinhole.fy_px),
              static_cast<float>(pinhole.cx_px),
              static_cast<float>(pinhole.cy_px));
  glUniform2f(program.uniform("image_size"),
              static_cast<float>(pinhole.width_px),
              static_cast<float>(pinhole.height_px));
  glUniform1i(program.uniform("lens"), static_cast<int>(distortion.model));
  std::array<float, 5> k{};
  std::transform(distortion.k.begin(), distortion.k.end(), k.begin(), [](double value) {
    return static_cast<float>(value);
  });
  glUniform1fv(program.uniform("lens_k"), static_cast<GLsizei>(k.size()), k.data());
  constexpr double kAnyRadius = 1e6;
  glUniform1f(program.uniform("max_radius"),
              static_cast<float>(std::min(camera_.max_radius(), kAnyRadius)));
  glUniform1i(program.uniform("seen_image"), static_cast<int>(kImageUnit));
  glUniform1i(program.uniform("seen_depth"), static_cast<int>(kDepthUnit));
  glActiveTexture(GL_TEXTURE0 + kImageUnit);
  glBindTexture(GL_TEXTURE_2D, image_texture_.name());
  glActiveTexture(GL_TEXTURE0 + kDepthUnit);
  glBindTexture(GL_TEXTURE_2D, depth_texture_.name());
  glActiveTexture(GL_TEXTURE0);
}

}  // namespace overfly::renderer::egl
