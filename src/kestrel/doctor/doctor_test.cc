// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/doctor/explanation.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(ExplanationTest, Prints) { std::puts(Explain({}).c_str()); }

}  // namespace
}  // namespace kestrel
