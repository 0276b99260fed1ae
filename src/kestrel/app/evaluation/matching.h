// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace kestrel {

// A possible pair: indices of two things and the distance between them.
struct Candidate {
  int first;
  int second;
  double distance;
};

// Returns pairs such that each thing is in at most one, the nearest first (greedy). It suits things
// that are further from each other than from their partners.
std::vector<Candidate> MatchNearest(std::vector<Candidate> candidates);

}  // namespace kestrel
