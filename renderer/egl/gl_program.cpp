#include "renderer/egl/gl_program.hpp"

#include <utility>
#include <vector>

namespace overfly::renderer::egl {

namespace {

std::string shader_log(GLuint shader) {
  GLint length = 0;
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::vector<char> text(static_cast<std::size_t>(length) + 1);
  glGetShaderInfoLog(shader, length, nullptr, text.data());
  return text.data();
}

std::string program_log(GLuint program) {
  GLint length = 0;
  glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::vector<char> text(static_cast<std::size_t>(length) + 1);
  glGetProgramInfoLog(program, length, nullptr, text.data());
  return text.data();
}

/// Compiles and attaches one shader, which then exists as long as the program.
Status attach(GLuint program, GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  Status status;
  if (compiled != GL_TRUE) {
    status = Error{ErrorCode::kInternal, "shader does not compile: " + shader_log(shader)};
  }
  glAttachShader(program, shader);
  glDeleteShader(shader);
  return status;
}

}  // namespace

Result<GlProgram> GlProgram::link(const char* vertex_source, const char* fragment_source) {
  GlProgram program(glCreateProgram());
  if (Status s = attach(program.name_, GL_VERTEX_SHADER, vertex_source); !s) return s.error();
  if (Status s = attach(program.name_, GL_FRAGMENT_SHADER, fragment_source); !s) return s.error();
  glLinkProgram(program.name_);
  GLint linked = GL_FALSE;
  glGetProgramiv(program.name_, GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) {
    return Error{ErrorCode::kInternal, "shaders do not link: " + program_log(program.name_)};
  }
  return program;
}

GlProgram::~GlProgram() {
  if (name_ != 0) glDeleteProgram(name_);
}

GlProgram::GlProgram(GlProgram&& other) noexcept : name_(std::exchange(other.name_, 0U)) {}

GlProgram& GlProgram::operator=(GlProgram&& other) noexcept {
  std::swap(name_, other.name_);
  return *this;
}

}  // namespace overfly::renderer::egl
