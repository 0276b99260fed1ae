// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/hunt_sink.h"

#include "kestrel/io/recording/map_inset.h"
#include "kestrel/io/recording/object_csv.h"
#include "kestrel/io/recording/object_map_files.h"
#include "kestrel/io/recording/object_overlay.h"

namespace kestrel {

HuntSink::HuntSink(const OutputOptions& output, const std::vector<double>& origin)
    : results_(output, "object_detections.csv", ObjectCsvHeader()), origin_(origin) {}

void HuntSink::Write(const Frame& frame, const HuntObservation& observation,
                     const HuntPipeline& pipeline) {
  const ObjectModel& model = pipeline.detector().model();
  results_.WriteRows(ObjectCsvRows(frame.name, observation, model));
  if (!results_.wants_pictures()) return;
  cv::Mat drawn = DrawObjectOverlay(frame.image, model, observation);
  if (const auto& pose = observation.world_from_camera) {
    DrawMapInset(pipeline.map().Confirmed(), model, pose->translation.head<2>(), &drawn);
  }
  results_.WritePicture(frame.name, drawn);
}

void HuntSink::WriteMap(const HuntPipeline& pipeline) const {
  if (const OutputFolder* const folder = results_.folder())
    WriteObjectMap(pipeline, origin_, *folder);
}

void HuntSink::WriteTeamMap(TeamLink* team) const {
  if (const OutputFolder* const folder = results_.folder()) team->WriteMap(origin_, *folder);
}

}  // namespace kestrel
