// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "kestrel/io/bags/open_recording.h"

namespace kestrel {

// Options for reading a bag. Must live until the command line is parsed.
struct BagArguments {
  std::vector<std::string> topics;
  bool use_arrival_times = false;

  void AddTo(CLI::App* command);

  // The bag, or other recording, that the arguments name. Says on stderr which parts of a bag are
  // cut off or left out.
  RecordingChoice Recording(const std::vector<std::string>& sources,
                            PixelFormat format = PixelFormat::kGray) const;
};

}  // namespace kestrel
