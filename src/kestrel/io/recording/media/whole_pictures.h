// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gst/gst.h>

namespace kestrel {

// Keeps a stream's pictures from the decoder that lack a packet or refer to one that does: after a
// gap in the numbers of its packets, and at its beginning, those before the next whole key frame. A
// decoder conceals what is missing, mostly without a flag. 'depayloader': takes RTP. No effect on
// other elements.
void PassWholePicturesOnly(GstElement* depayloader);

}  // namespace kestrel
