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

// A pipeline and what becomes of its results: all that the commands differ in.
class PipelineRun {
 public:
  virtual ~PipelineRun() = default;

  virtual void AddPose(const PoseSample& pose) = 0;

  // The last light of a frame is so much later than its time; poses are needed until then.
  virtual Duration after_frame() const { return Duration::zero(); }

  // Processes the frame and writes what it showed. Returns the time of the detection alone.
  virtual Duration Process(const Frame& frame) = 0;

  // What contradicts what, as far as it is known by now; empty where nothing does.
  virtual std::string Warning() const { return ""; }

  // Writes what there is after the last frame, or after Ctrl-C.
  virtual void Finish() {}

  // What was found, for the line at the end ("pattern found in 12"); and lines to go below it.
  virtual std::string Found() const = 0;
  virtual std::string Remarks() const = 0;
};

// What --dds asks for; null without. Waits a second for those who hear: the frames of a recording
// do not wait. Throws InputError when DDS is at fault.
std::unique_ptr<RosResults> OpenRosResults(const SourceArguments& arguments,
                                           const OpenedSource& opened,
                                           const KestrelOptions& options, bool is_still,
                                           const ObjectModel& model);

// Gives the run all poses and frames of the source, in the order of time, and says on stderr what
// was found, and its first warning as soon as there is one. When the source ends with an
// InputError, that is said all the same: the results stay.
void RunPipeline(const OpenedSource& opened, PipelineRun* run);

}  // namespace kestrel
