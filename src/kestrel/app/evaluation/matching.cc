// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/matching.h"

#include <algorithm>
#include <set>

namespace kestrel {

std::vector<Candidate> MatchNearest(std::vector<Candidate> candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  std::set<int> firsts, seconds;
  std::erase_if(candidates, [&](const Candidate& c) {
    if (firsts.contains(c.first) || seconds.contains(c.second)) return true;
    firsts.insert(c.first);
    seconds.insert(c.second);
    return false;
  });
  return candidates;
}

}  // namespace kestrel
