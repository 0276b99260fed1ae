// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/flight/onboard/open_live_source.h"
#include "kestrel/flight/ros/dds_source.h"
#include "kestrel/io/bags/open_recording.h"
#include "kestrel/simulation/autopilots/simulated_source.h"

namespace kestrel {

// The live source of a flight, by its name, with the schemes "dds:" and "sim:". Stays where it is
// once it is open.
struct FlySource {
  // 'open_node': called when a topic is opened.
  FlySource(const KestrelOptions& options, DdsSource::OpenNode open_node);
  FlySource(const FlySource&) = delete;
  FlySource& operator=(const FlySource&) = delete;

  // Throws InputError as OpenLiveSource does.
  void Open(const RecordingChoice& recording, bool is_looped);
  // Opens several cameras, or several topics of "dds:", see OpenLiveCameras.
  void Open(const std::vector<RecordingChoice>& cameras,
            const std::function<void(const std::string&)>& notify);

  SimulatedSource simulated;  // owns what 'live' renders
  DdsSource dds;
  OpenedLiveSource live;  // empty until Open

 private:
  GstreamerCameraOptions camera_;
};

}  // namespace kestrel
