// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/silence_gstreamer.h"

#include <cstdlib>
#include <gst/gst.h>

namespace kestrel {

void SilenceGstreamer() {
  if (std::getenv("GST_DEBUG") != nullptr) return;
  gst_debug_set_active(FALSE);
  g_log_set_default_handler([](const gchar*, GLogLevelFlags, const gchar*, gpointer) {}, nullptr);
}

void UnsilenceGstreamer() {
  gst_debug_set_active(TRUE);
  gst_debug_set_default_threshold(GST_LEVEL_WARNING);
  g_log_set_default_handler(g_log_default_handler, nullptr);
}

}  // namespace kestrel
