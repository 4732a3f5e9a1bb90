// A linked shader program.
#pragma once

#include <epoxy/gl.h>

#include <string>

#include "core/result.hpp"

namespace overfly::renderer::egl {

class GlProgram {
 public:
  /// Errors: kInternal with the compiler's log.
  static Result<GlProgram> link(const char* vertex_source, const char* fragment_source);
  ~GlProgram();
  GlProgram(GlProgram&& other) noexcept;
  GlProgram& operator=(GlProgram&& other) noexcept;
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;

  void use() const { glUseProgram(name_); }
  /// Location of a uniform; -1 (ignored by setters) if the program does not use it.
  [[nodiscard]] GLint uniform(const char* name) const { return glGetUniformLocation(name_, name); }

 private:
  explicit GlProgram(GLuint name) : name_(name) {}
  GLuint name_ = 0;
};

}  // namespace overfly::renderer::egl
