// SPDX-License-Identifier: BSD-3-Clause
// Loaded before a program (LD_PRELOAD), limits Highway to vector instructions that every computer
// has: sums are rounded alike on all of them.
#include <cstdint>

#include <hwy/targets.h>

namespace {

[[maybe_unused]] const bool is_fixed = [] {
  hwy::DisableTargets(~static_cast<std::int64_t>(HWY_SSSE3 | HWY_STATIC_TARGET));
  return true;
}();

}  // namespace
