// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "kestrel/io/bags/bag_source.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// The options that say how a bag is read. Must live until the command line is parsed.
struct BagArguments {
  std::vector<std::string> topics;
  bool use_arrival_times = false;

  void AddTo(CLI::App* command);

  // Opens what the arguments name, a bag or another source; says on stderr what of a bag was cut
  // off or left out. Throws InputError with what is wrong with it.
  std::unique_ptr<FrameSource> Open(const std::vector<std::string>& sources,
                                    PixelFormat format = PixelFormat::kGray) const;
};

}  // namespace kestrel
