// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/autopilot_model_options.h"

namespace kestrel {

// A good estimate: its errors are not under test.
AutopilotModelOptions::AutopilotModelOptions() {
  navigation.position_noise_m = 0.003;
  navigation.position_drift_m = 0.005;
  navigation.position_bias_m = 0;
  navigation.attitude_noise_deg = 0.05;
  navigation.attitude_bias_deg = 0.05;
  navigation.mount_error_deg = 0;
  navigation.clock_offset_min_s = 0;
  navigation.clock_offset_max_s = 0;
}

}  // namespace kestrel
