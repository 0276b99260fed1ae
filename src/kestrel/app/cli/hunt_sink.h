// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/app/cli/result_sink.h"
#include "kestrel/app/cli/team_link.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// Writes the results of the hunt pipeline: detections, annotated frames and finally the map. Throws
// InputError when it cannot write.
class HuntSink {
 public:
  // 'origin': latitude and longitude (degrees) of the world's origin, or empty.
  HuntSink(const OutputOptions& output, const std::vector<double>& origin);

  void Write(const Frame& frame, const HuntObservation& observation, const HuntPipeline& pipeline);

  // Both maps are written to files only, never to stdout.
  void WriteMap(const HuntPipeline& pipeline) const;
  void WriteTeamMap(TeamLink* team) const;

 private:
  ResultSink results_;
  std::vector<double> origin_;
};

}  // namespace kestrel
