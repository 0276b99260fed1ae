// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/fly/fly_source.h"

#include <cstdint>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/media/video_address.h"
#include "kestrel/io/recording/open_source.h"

namespace kestrel {

FlySource::FlySource(const KestrelOptions& options, DdsSource::OpenNode open_node)
    : simulated(options.fly.sim_camera, options.landing.target,
                static_cast<std::uint64_t>(options.fly.sim_seed)),
      dds(options.dds, std::move(open_node),
          [](const std::string& text) { fmt::print(stderr, "kestrel: {}\n", text); }),
      camera_(options.fly.camera) {}

void FlySource::Open(const RecordingChoice& recording, bool is_looped) {
  const std::string& source = recording.sources.front();
  if (IsCamera(source) && recording.camera.empty() && !recording.may_assume_lens) {
    throw InputError(fmt::format(
        "{}: no calibration: nothing can be measured, and nothing sent to an autopilot, without "
        "one: --camera FILE (kestrel calibrate lens makes one)",
        WithoutPassword(source)));
  }
  live = OpenLiveSource({recording, is_looped}, camera_, {dds.Scheme(), simulated.Scheme()});
}

}  // namespace kestrel
