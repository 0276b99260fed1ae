// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/pipeline/ground_height.h"

#include <limits>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

constexpr GroundHeight kTold{0, 0.05};

}  // namespace
}  // namespace kestrel
