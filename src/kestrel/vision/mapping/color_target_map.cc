// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/mapping/color_target_map.h"

#include <algorithm>

namespace kestrel {

int ColorTarget::most_likely_score() const {
  Eigen::Index best = 0;
  score_likelihoods.maxCoeff(&best);
  return static_cast<int>(best);
}

void ColorTargetMap::Update(std::span<const ColorTarget> detections) {
  for (const ColorTarget& d : detections) {
    const auto distance = [&](const ColorTarget& m) { return (m.position - d.position).norm(); };
    const auto m = std::min_element(  // #5.1
        objects_.begin(), objects_.end(),
        [&](const ColorTarget& a, const ColorTarget& b) { return distance(a) < distance(b); });
    if (m == objects_.end() || distance(*m) >= max_error_m_) {  // #5.2
      objects_.push_back(d);                                    // #5.8
      continue;
    }
    const double n = m->detections;
    m->position = (n * m->position + d.position) / (n + 1);  // #5.3
    m->color = (n * m->color + d.color) / (n + 1);           // #5.4
    m->score_likelihoods += d.score_likelihoods;             // #5.5, and so #5.6
    ++m->detections;                                         // #5.7
  }
}

}  // namespace kestrel
