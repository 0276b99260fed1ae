// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace kestrel {

// Two things that are near each other.
struct Candidate {
  int first;
  int second;
  double distance;
};

// Pairs such that each thing is in one at most: the nearest first (greedy), for things that are
// further from each other than from their partners.
std::vector<Candidate> MatchNearest(std::vector<Candidate> candidates);

}  // namespace kestrel
