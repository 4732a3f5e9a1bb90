#include "tests/support/allocation_failure.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace overfly::testing {
namespace {

thread_local bool marked = false;
std::atomic<int> allocations_left{-1};  ///< below 0: none fails
std::atomic<bool> failed{false};

bool fails_now() {
  if (!marked || allocations_left.load() < 0) return false;
  if (allocations_left.fetch_sub(1) != 0) return false;
  failed = true;
  return true;
}

}  // namespace

void AllocationFailure::may_fail_here() { marked = true; }

void AllocationFailure::arm(int before) {
  failed = false;
  allocations_left = before;
}

bool AllocationFailure::disarm() {
  allocations_left = -1;
  return failed;
}

void* allocate_or_null(std::size_t bytes) noexcept {
  return fails_now() ? nullptr : std::malloc(bytes == 0 ? 1 : bytes);
}

void* allocate(std::size_t bytes) {
  void* memory = allocate_or_null(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace overfly::testing

// Those of this test program, the libraries that it links included. All that may meet one another:
// AddressSanitizer has its own for each that is not here, and would see its memory freed by ours.
void* operator new(std::size_t bytes) { return overfly::testing::allocate(bytes); }
void* operator new[](std::size_t bytes) { return overfly::testing::allocate(bytes); }
void* operator new(std::size_t bytes, const std::nothrow_t& /*kind*/) noexcept {
  return overfly::testing::allocate_or_null(bytes);
}
void* operator new[](std::size_t bytes, const std::nothrow_t& /*kind*/) noexcept {
  return overfly::testing::allocate_or_null(bytes);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*bytes*/) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t /*bytes*/) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t& /*kind*/) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t& /*kind*/) noexcept { std::free(memory); }
