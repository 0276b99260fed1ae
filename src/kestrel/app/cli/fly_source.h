// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/flight/onboard/open_live_source.h"
#include "kestrel/flight/ros/dds_source.h"
#include "kestrel/simulation/autopilots/simulated_source.h"

namespace kestrel {

// The live source that the arguments name, with the schemes that the command knows: "dds:", "sim:".
// Stays where it is once it is open. 'arguments' outlives it.
struct FlySource {
  FlySource(const SourceArguments& arguments, const KestrelOptions& options);
  FlySource(const FlySource&) = delete;
  FlySource& operator=(const FlySource&) = delete;

  // Throws InputError as OpenLiveSource does.
  void Open(PixelFormat format, bool is_looped);

  SimulatedSource simulated;  // owns what 'live' renders
  DdsSource dds;
  OpenedLiveSource live;  // empty until Open

 private:
  const SourceArguments& arguments_;
  GstreamerCameraOptions camera_;
};

}  // namespace kestrel
