// Read errors of heights. Height queries cannot report them, and their users share one world.
#pragma once

#include <optional>

#include "core/result.hpp"

namespace overfly::terrain {

/// Collects the errors of the height queries that this thread makes while the object exists. They
/// are not those of other users of the same world. To be used as a local variable.
class HeightErrors {
 public:
  HeightErrors();
  ~HeightErrors();
  HeightErrors(const HeightErrors&) = delete;
  HeightErrors& operator=(const HeightErrors&) = delete;

  /// The first one, if there is one.
  [[nodiscard]] Status status() const { return first_ ? Status(*first_) : Status(); }

  /// Called where a height could not be read: all objects of this thread collect the error.
  static void add(const Error& error);

 private:
  HeightErrors* outer_;                 ///< the one of this thread before
  mutable std::optional<Error> first_;  ///< set by add(), also of a const variable
};

}  // namespace overfly::terrain
