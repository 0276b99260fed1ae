// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/hunt_files.h"

#include <variant>

#include "kestrel/io/recording/overlays/object_overlay.h"
#include "kestrel/io/recording/tables/object_csv.h"
#include "kestrel/io/recording/tables/object_map_files.h"

namespace kestrel {

HuntFiles::HuntFiles(const OutputOptions& output, const HuntPipeline* pipeline, bool has_map,
                     const std::vector<double>& origin)
    : pipeline_(pipeline),
      only_in_image_(output.only_in_image),
      results_(output, "object_detections.csv", ObjectCsvHeader()),
      has_map_(has_map),
      origin_(origin) {}

void HuntFiles::Take(const Observation& observation) {
  const Frame& frame = observation.frame;
  HuntObservation seen = std::get<HuntObservation>(observation.seen);
  if (only_in_image_) {
    for (ObjectDetection& detection : seen.report.detections) detection.location.reset();
  }
  const ObjectModel& model = pipeline_->detector().model();
  results_.WriteRows(ObjectCsvRows(frame.name, seen, model));
  if (!results_.wants_pictures()) return;
  results_.WritePicture(frame.name,
                        DrawObjectOverlay(frame.image, model, seen, pipeline_->map().Confirmed()));
}

void HuntFiles::Take(const BrokenFrame& frame) {
  HuntObservation nothing;
  nothing.time = frame.time;
  results_.WriteRows(ObjectCsvRows(frame.name, nothing, pipeline_->detector().model()));
}

void HuntFiles::Finish() {
  if (has_map_ && folder() != nullptr) WriteObjectMap(*pipeline_, origin_, *folder());
}

}  // namespace kestrel
