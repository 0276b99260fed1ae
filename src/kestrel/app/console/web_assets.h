// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "kestrel/app/web_server/web_asset.h"

namespace kestrel {

// The files of web/page, which the build puts into the program.
std::span<const WebAsset> WebAssets();

}  // namespace kestrel
