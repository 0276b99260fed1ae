// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "kestrel/io/bags/bag_source.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// Options for reading a bag. Must live until the command line is parsed.
struct BagArguments {
  std::vector<std::string> topics;
  bool use_arrival_times = false;

  void AddTo(CLI::App* command);

  // Opens the bag or other source that the arguments name. Says on stderr which parts of a bag are
  // cut off or left out. Throws InputError that says what is wrong with the source.
  std::unique_ptr<FrameSource> Open(const std::vector<std::string>& sources,
                                    PixelFormat format = PixelFormat::kGray) const;
};

}  // namespace kestrel
