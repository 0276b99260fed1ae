// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/fly/fly_source.h"

#include <cstdint>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace kestrel {

FlySource::FlySource(const KestrelOptions& options, DdsSource::OpenNode open_node)
    : simulated(options.fly.sim_camera, options.landing.target,
                static_cast<std::uint64_t>(options.fly.sim_seed)),
      dds(options.dds, std::move(open_node),
          [](const std::string& text) { fmt::print(stderr, "kestrel: {}\n", text); }),
      camera_(options.fly.camera) {}

void FlySource::Open(const RecordingChoice& recording, bool is_looped) {
  live = OpenLiveSource({recording, is_looped}, camera_, {dds.Scheme(), simulated.Scheme()});
}

}  // namespace kestrel
