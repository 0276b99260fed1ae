// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/session/asynchronous_sink.h"
#include "kestrel/flight/session/task.h"

namespace kestrel {

// Returns a sink that writes an MCAP file of a task's results as ObservationFile does. 'further':
// the cameras after the first, with their names. 'notify' is
// called by the writing thread with a text: that the file cannot be written any more (the session
// goes on), or how many frames are left out. Throws InputError as ObservationFile does.
std::unique_ptr<AsynchronousSink> OpenMcapSink(const std::string& path, bool replace,
                                               const Task& task,
                                               const CameraCalibration& calibration,
                                               const std::vector<CameraCalibration>& further,
                                               std::function<void(const std::string&)> notify);

// Returns a sink that writes an MCAP file in the caller's thread and leaves nothing out; for
// sessions over recordings. 'further' as above. Take and Finish throw InputError as ObservationFile
// does.
std::unique_ptr<ObservationSink> OpenMcapFile(const std::string& path, bool replace,
                                              const Task& task,
                                              const CameraCalibration& calibration,
                                              const std::vector<CameraCalibration>& further = {});

}  // namespace kestrel
