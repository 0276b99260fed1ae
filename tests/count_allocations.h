// SPDX-License-Identifier: BSD-3-Clause
// Counts allocations by replacing the C library's functions (glibc), which operator new and cv::Mat
// use too. Include it in one source file of a program.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <mm_malloc.h>  // declares them once more, and must not differ

namespace {

thread_local bool is_counting = false;
thread_local int allocation_count = 0;

void CountAllocation() {
  if (is_counting) ++allocation_count;
}

}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t align, std::size_t size);

void* malloc(std::size_t size) noexcept {
  CountAllocation();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  CountAllocation();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  CountAllocation();
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t align, std::size_t size) noexcept {
  CountAllocation();
  return __libc_memalign(align, size);
}
int posix_memalign(void** memory, std::size_t align, std::size_t size) noexcept {
  CountAllocation();
  *memory = __libc_memalign(align, size);
  return *memory == nullptr ? ENOMEM : 0;
}
}

namespace kestrel {

// Returns the number of allocations of 'action' on this thread.
template <class Action>
int CountAllocations(const Action& action) {
  allocation_count = 0;
  is_counting = true;
  action();
  is_counting = false;
  return allocation_count;
}

}  // namespace kestrel
