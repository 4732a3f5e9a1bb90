#include "terrain/height_errors.hpp"

namespace overfly::terrain {
namespace {

thread_local HeightErrors* innermost_errors = nullptr;

}  // namespace

HeightErrors::HeightErrors() : outer_(innermost_errors) { innermost_errors = this; }

HeightErrors::~HeightErrors() { innermost_errors = outer_; }

void HeightErrors::add(const Error& error) {
  for (HeightErrors* errors = innermost_errors; errors != nullptr; errors = errors->outer_) {
    if (!errors->first_) errors->first_ = error;
  }
}

}  // namespace overfly::terrain
