#include "middleware/lcm/lengths.hpp"

#include <algorithm>

namespace overfly::lcm {
namespace {

/// Sizes in LCM's encoding: big-endian numbers without padding, preceded by a hash of the type.
constexpr std::size_t kHash = 8;
constexpr std::size_t kByte = 1;
constexpr std::size_t kInt32 = 4;
constexpr std::size_t kInt64 = 8;
constexpr std::size_t kFloat = 4;
constexpr std::size_t kDouble = 8;

class Walk {
 public:
  explicit Walk(std::span<const std::uint8_t> bytes) : rest_(bytes) { skip(kHash); }

  void skip(std::size_t bytes) {
    sound_ = sound_ && bytes <= rest_.size();
    rest_ = sound_ ? rest_.subspan(bytes) : std::span<const std::uint8_t>{};
  }

  /// A number of elements, each of at least one byte.
  std::size_t count() {
    const std::span<const std::uint8_t> digits = rest_.first(std::min(kInt32, rest_.size()));
    skip(kInt32);
    std::uint32_t number = 0;
    for (const std::uint8_t digit : digits) number = (number << 8U) | digit;
    // A negative number is large here.
    sound_ = sound_ && number <= rest_.size();
    return sound_ ? number : 0;
  }

  void text() { skip(count()); }

  void named_numbers() {
    for (std::size_t left = count(); left > 0 && sound_; --left) {
      text();
      skip(kDouble);
    }
  }

  void texts(std::size_t number) {
    for (; number > 0 && sound_; --number) text();
  }

  [[nodiscard]] bool sound() const { return sound_; }

 private:
  std::span<const std::uint8_t> rest_;
  bool sound_ = true;
};

}  // namespace

bool lengths_fit(std::span<const std::uint8_t> bytes, const overfly_lcm::pose_t& /*type*/) {
  Walk walk(bytes);
  walk.skip(5 * kInt64 + kInt32 + kByte + kInt64 + 2 * kByte + kInt32 + 8 * kDouble);
  walk.named_numbers();
  walk.named_numbers();
  return walk.sound();
}

bool lengths_fit(std::span<const std::uint8_t> bytes, const overfly_lcm::debug_t& /*type*/) {
  Walk walk(bytes);
  walk.skip(4 * kInt64 + 2 * kInt32);
  walk.skip(walk.count());
  walk.skip(walk.count() * 3 * kFloat);
  return walk.sound();
}

bool lengths_fit(std::span<const std::uint8_t> bytes, const overfly_lcm::status_t& /*type*/) {
  Walk walk(bytes);
  walk.skip(2 * kInt64);
  walk.texts(2);
  walk.skip(kInt64 + 2 * kDouble);
  walk.texts(2 * walk.count());
  walk.texts(walk.count());
  return walk.sound();
}

}  // namespace overfly::lcm
