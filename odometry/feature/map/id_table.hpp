// Objects by ascending id: the points of the map.
#pragma once

#include <cstddef>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace overfly::odometry::feature {

/// Objects with a member `id`, in order of their ids, which are given out in ascending order. An
/// object is found by its place in a vector: tracking looks up a thousand points in each frame.
/// References stay valid until their object is erased.
template <typename Object>
class IdTable {
  using Slots = std::vector<std::unique_ptr<Object>>;

  /// Skips the places of erased objects.
  template <typename Item, typename Slot>
  class Walk {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = Object;
    using difference_type = std::ptrdiff_t;
    using pointer = Item*;
    using reference = Item&;

    Walk(Slot at, Slot end) : at_(at), end_(end) { skip(); }
    reference operator*() const { return **at_; }
    pointer operator->() const { return at_->get(); }
    Walk& operator++() {
      ++at_;
      skip();
      return *this;
    }
    bool operator==(const Walk& other) const { return at_ == other.at_; }

   private:
    void skip() {
      while (at_ != end_ && *at_ == nullptr) ++at_;
    }
    Slot at_, end_;
  };

 public:
  /// @param object  its id is larger than that of all objects so far
  Object& add(Object object) {
    if (count_ == 0) {
      slots_.clear();
      first_ = object.id;
    }
    slots_.resize(static_cast<std::size_t>(object.id - first_));
    ++count_;
    return *slots_.emplace_back(std::make_unique<Object>(std::move(object)));
  }
  void erase(int id) {
    if (find(id) == nullptr) return;
    slots_[static_cast<std::size_t>(id - first_)].reset();
    --count_;
  }
  /// Releases the places of erased objects before the first one.
  void trim() {
    auto i = slots_.begin();
    while (i != slots_.end() && *i == nullptr) ++i;
    first_ += static_cast<int>(i - slots_.begin());
    slots_.erase(slots_.begin(), i);
  }
  /// Null if there is none.
  [[nodiscard]] const Object* find(int id) const {
    const auto place = static_cast<std::size_t>(id) - static_cast<std::size_t>(first_);
    return place < slots_.size() ? slots_[place].get() : nullptr;
  }
  [[nodiscard]] Object* find(int id) { return const_cast<Object*>(std::as_const(*this).find(id)); }
  /// @throws std::out_of_range if there is none
  [[nodiscard]] Object& at(int id) {
    if (Object* object = find(id)) return *object;
    throw std::out_of_range("no object has the id " + std::to_string(id));
  }
  [[nodiscard]] std::size_t size() const { return count_; }

  [[nodiscard]] auto begin() {
    return Walk<Object, typename Slots::iterator>(slots_.begin(), slots_.end());
  }
  [[nodiscard]] auto end() {
    return Walk<Object, typename Slots::iterator>(slots_.end(), slots_.end());
  }
  [[nodiscard]] auto begin() const {
    return Walk<const Object, typename Slots::const_iterator>(slots_.begin(), slots_.end());
  }
  [[nodiscard]] auto end() const {
    return Walk<const Object, typename Slots::const_iterator>(slots_.end(), slots_.end());
  }

 private:
  Slots slots_;  ///< by id - first_; null where the object was erased
  int first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace overfly::odometry::feature
