// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "kestrel/flight/session/observation_sink.h"

namespace kestrel {

// Returns a sink that keeps two pictures a second while guidance is at an object: PNG files named
// by the time of their capture (ns), and in places.csv where the camera was. 'folder' is made with
// the first one. A thread of its own writes them. 'notify' receives lines for the user, from it.
std::unique_ptr<ObservationSink> MakeLookPictures(std::filesystem::path folder,
                                                  std::function<void(const std::string&)> notify);

}  // namespace kestrel
