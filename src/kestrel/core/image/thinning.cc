// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/thinning.h"

#include <algorithm>

namespace kestrel {
namespace {

// Returns the pixels of a row that one sub-iteration deletes, for all columns at once. The
// neighbours are numbered as in the reference: p2 above, then clockwise to p9 at the upper left.
std::uint64_t Deletable(std::uint64_t above, std::uint64_t here, std::uint64_t below, bool odd) {
  const std::uint64_t p2 = above, p3 = above >> 1, p4 = here >> 1, p5 = below >> 1;
  const std::uint64_t p6 = below, p7 = below << 1, p8 = here << 1, p9 = above << 1;

  // C = 1: exactly one 8-connected component among the neighbours.
  const std::uint64_t c1 = ~p2 & (p3 | p4), c2 = ~p4 & (p5 | p6);
  const std::uint64_t c3 = ~p6 & (p7 | p8), c4 = ~p8 & (p9 | p2);
  const std::uint64_t one = c1 ^ c2 ^ c3 ^ c4;
  const std::uint64_t more = (c1 & c2) | (c3 & c4) | ((c1 | c2) & (c3 | c4));
  const std::uint64_t single = one & ~more;

  // 2 <= N <= 3, where N is the smaller of the two counts of set neighbour pairs.
  const auto count = [](std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d,
                        std::uint64_t* at_least_2, std::uint64_t* all) {
    *at_least_2 = (a & b) | (c & d) | ((a | b) & (c | d));
    *all = a & b & c & d;
  };
  std::uint64_t n1_two, n1_four, n2_two, n2_four;
  count(p9 | p2, p3 | p4, p5 | p6, p7 | p8, &n1_two, &n1_four);
  count(p2 | p3, p4 | p5, p6 | p7, p8 | p9, &n2_two, &n2_four);
  const std::uint64_t n_in_range = n1_two & n2_two & ~(n1_four & n2_four);

  const std::uint64_t keep = odd ? (p2 | p3 | ~p5) & p4 : (p6 | p7 | ~p9) & p8;
  return here & single & n_in_range & ~keep;
}

bool SubIteration(SmallMask* mask, bool odd) {
  bool changed = false;
  std::uint64_t above = 0;  // before this sub-iteration
  for (int y = 0; y < mask->size(); ++y) {
    const std::uint64_t here = mask->row(y);
    const std::uint64_t deleted = Deletable(above, here, mask->row(y + 1), odd);
    changed |= deleted != 0;
    mask->SetRow(y, here & ~deleted);
    above = here;
  }
  return changed;
}

}  // namespace

void ThinGuoHall(SmallMask* mask, int max_iterations) {
  for (int i = 0; i < max_iterations; ++i) {
    const bool odd_changed = SubIteration(mask, true);
    const bool even_changed = SubIteration(mask, false);
    if (!odd_changed && !even_changed) return;
  }
}

}  // namespace kestrel
