// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "casters.h"
#include "kestrel/open_recording.h"

namespace kestrel::python {

// Returns the sources that an argument names: a path, or a list of them. Throws TypeError.
std::vector<std::string> SourcesOf(const pybind11::object& source);

// Returns the choice of a recording. 'camera': path of its calibration, or None.
RecordingChoice ChoiceOf(const pybind11::object& source, const pybind11::object& camera,
                         PixelFormat format);

// Opens it, and issues Python's warnings of what the user should know. Throws as OpenRecording.
OpenedSource OpenWithWarnings(RecordingChoice choice);

// A recording of Python: it can be opened any number of times, from its beginning.
struct Recording {
  std::string name;
  std::function<OpenedSource()> open;
  OpenedSource opened;  // for questions; frames are read from others
};

}  // namespace kestrel::python
