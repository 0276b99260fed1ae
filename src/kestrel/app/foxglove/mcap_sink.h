// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/session/asynchronous_sink.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

struct HuntView;
struct LandingView;

// Returns a sink that writes an MCAP file as ObservationFile does. 'tell' is called by the writing
// thread with a text: that the file cannot be written any more (the session goes on), or how many
// frames are left out. Throws InputError as ObservationFile does.
std::unique_ptr<AsynchronousSink> OpenMcapSink(const std::string& path, bool replace,
                                               const CameraIntrinsics& camera,
                                               const std::variant<LandingView, HuntView>& view,
                                               std::function<void(const std::string&)> tell);

// Returns a sink that writes an MCAP file in the caller's thread and leaves nothing out; for
// sessions over recordings. Take and Finish throw InputError as ObservationFile does.
std::unique_ptr<ObservationSink> OpenMcapFile(const std::string& path, bool replace,
                                              const CameraIntrinsics& camera,
                                              const std::variant<LandingView, HuntView>& view);

// Return sinks as OpenMcapSink does, of a landing with these options and of a hunt for these
// objects.
std::unique_ptr<AsynchronousSink> OpenLandingMcapSink(const std::string& path, bool replace,
                                                      const CameraCalibration& calibration,
                                                      const LandingPipelineOptions& options,
                                                      std::function<void(const std::string&)> tell);
std::unique_ptr<AsynchronousSink> OpenHuntMcapSink(const std::string& path, bool replace,
                                                   const CameraCalibration& calibration,
                                                   const ObjectModel& objects,
                                                   std::function<void(const std::string&)> tell);

}  // namespace kestrel
