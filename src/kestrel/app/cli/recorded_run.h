// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/flight/onboard/session.h"
#include "kestrel/io/bags/open_recording.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// Adds the sink of --dds, if it is given. 'has_world': results have places in the world. Throws
// InputError when DDS fails.
void AddDdsSink(const SourceArguments& arguments, const OpenedSource& opened,
                const KestrelOptions& options, const Task& task, bool has_world,
                const ObjectModel& model, ObservationSinks* sinks);

// Adds the sink of --mcap, if it is given. Throws InputError as OpenMcapFile does, and when the
// file is a source.
void AddMcapSink(const SourceArguments& arguments, const OpenedSource& opened, const Task& task,
                 ObservationSinks* sinks);

// Runs a session over a recording, to its end or Ctrl-C. Shows its progress, the first warning and
// the summary on stderr. When it ends with an InputError the summary is shown all the same and the
// results are kept. 'on_frame': called before each frame with the number of frames done.
void RunToEnd(
    const OpenedSource& opened, Session* session,
    const std::function<void(std::size_t done)>& on_frame = [](std::size_t) {});

}  // namespace kestrel
