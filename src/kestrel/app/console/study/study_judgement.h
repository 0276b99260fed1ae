// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace kestrel {

// Returns in words what recordings show of two configurations, as the verdict of
// `kestrel study report` begins: "Worse in both, too few to prove (2 recordings, 8 are the least)".
// That command alone judges enough recordings. 'changes': for each recording how many more
// the second found; empty: an empty text.
std::string StudyJudgement(const std::vector<std::int64_t>& changes);

}  // namespace kestrel
