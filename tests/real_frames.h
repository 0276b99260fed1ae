// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace kestrel {

// Why a test on frames that are not part of the repository is skipped.
inline constexpr char kNoRealFrames[] =
    "real frames: ../shared/data beside the repository has none";

}  // namespace kestrel
