// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "kestrel/app/cli/kestrel_options.h"
#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/ros/ros_results.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// A pipeline and the use of its results; the rest of a run is the same for all commands.
class PipelineRun {
 public:
  virtual ~PipelineRun() = default;

  virtual void AddPose(const PoseSample& pose) = 0;

  // Time from a frame's time to the end of its exposure; poses are needed until then.
  virtual Duration after_frame() const { return Duration::zero(); }

  // Processes the frame and writes its results. Returns the time of the detection alone.
  virtual Duration Process(const Frame& frame) = 0;

  // Returns the contradictions that are known so far; empty when there are none.
  virtual std::string Warning() const { return ""; }

  // Writes the results that come after the last frame, or after Ctrl-C.
  virtual void Finish() {}

  // Found() is for the last line ("pattern found in 12"), Remarks() are lines below it.
  virtual std::string Found() const = 0;
  virtual std::string Remarks() const = 0;
};

// Returns what --dds asks for; null without. Waits up to a second for subscribers, as the frames of
// a recording do not wait for them. Throws InputError when DDS fails.
std::unique_ptr<RosResults> OpenRosResults(const SourceArguments& arguments,
                                           const OpenedSource& opened,
                                           const KestrelOptions& options, bool is_still,
                                           const ObjectModel& model);

// Gives the run all poses and frames of the source in order of time. Says on stderr what was found
// and, as soon as there is one, the first warning. When the source ends with an InputError the
// summary is printed all the same and the results are kept.
void RunPipeline(const OpenedSource& opened, PipelineRun* run);

}  // namespace kestrel
