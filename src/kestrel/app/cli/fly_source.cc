// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/fly_source.h"

#include <cstdint>
#include <string>

#include <fmt/format.h>

namespace kestrel {

FlySource::FlySource(const SourceArguments& arguments, const KestrelOptions& options)
    : simulated(options.fly.sim_camera, options.landing.target,
                static_cast<std::uint64_t>(options.fly.sim_seed)),
      dds(
          options.dds, [&arguments, dds = options.dds] { return arguments.dds.OpenNode(dds); },
          [](const std::string& text) { fmt::print(stderr, "kestrel: {}\n", text); }),
      arguments_(arguments),
      camera_(options.fly.camera) {}

void FlySource::Open(PixelFormat format, bool is_looped) {
  live = OpenLiveSource({arguments_.Recording(format), is_looped}, camera_,
                        {dds.Scheme(), simulated.Scheme()});
}

}  // namespace kestrel
