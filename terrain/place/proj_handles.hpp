// Inside terrain only: PROJ's objects with an owner.
#pragma once

#include <proj.h>

#include <memory>

namespace overfly::terrain {

struct ProjContextCloser {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
};
struct ProjObjectCloser {
  void operator()(PJ* object) const { proj_destroy(object); }
};
using ProjContext = std::unique_ptr<PJ_CONTEXT, ProjContextCloser>;
using ProjObject = std::unique_ptr<PJ, ProjObjectCloser>;

}  // namespace overfly::terrain
