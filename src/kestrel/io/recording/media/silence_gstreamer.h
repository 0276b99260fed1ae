// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace kestrel {

// Keeps GStreamer and GLib from printing, for a program that reports each error once and in its own
// words. Does nothing where the environment has GST_DEBUG: somebody wants to read them.
void SilenceGstreamer();

// Lets GStreamer and GLib print again: errors and warnings.
void UnsilenceGstreamer();

}  // namespace kestrel
