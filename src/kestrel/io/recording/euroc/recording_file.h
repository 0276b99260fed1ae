// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace kestrel {

// A text file of a recording.
struct RecordingFile {
  std::string name;  // path below mav0
  std::string text;
};

}  // namespace kestrel
