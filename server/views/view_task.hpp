// Work for the thread that draws pictures.
#pragma once

#include "core/result.hpp"

namespace overfly::server {

class ViewPainter;

class ViewTask {
 public:
  virtual ~ViewTask() = default;
  /// Does the work and answers. @return false while its world is being opened: to be run again
  [[nodiscard]] virtual bool run(ViewPainter& painter) = 0;
  /// Answers with an error instead.
  virtual void refuse(const Error& reason) = 0;
};

}  // namespace overfly::server
