// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/flight/session/result_files.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// Writes the results of a hunt: detections, annotated frames and finally the map, which never goes
// to stdout. Waits for the disk; for sessions over recordings. Throws InputError when it cannot
// write.
class HuntFiles : public ObservationSink {
 public:
  // 'pipeline': the one that gives the observations; outlives this. 'has_map': objects have places
  // in the world. 'origin': latitude and longitude (degrees) of the world's origin, or empty.
  HuntFiles(const OutputOptions& output, const HuntPipeline* pipeline, bool has_map,
            const std::vector<double>& origin);

  void Take(const Observation& observation) override;
  void Take(const BrokenFrame& frame) override;
  void Finish() override;

  // Folder for further files; null where the table goes to stdout.
  const OutputFolder* folder() const { return results_.folder(); }

 private:
  const HuntPipeline* pipeline_;
  bool only_in_image_;
  ResultFiles results_;
  bool has_map_;
  std::vector<double> origin_;
};

}  // namespace kestrel
