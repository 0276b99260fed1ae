// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/replay_options.h"

#include <algorithm>
#include <string_view>
#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/base/options.h"

namespace kestrel {
namespace {

constexpr std::string_view kPrefix = "landing.";

constexpr std::string_view kNames[] = {"detector.pattern.outer_diameter_m",
                                       "detector.pattern.ring_width_m",
                                       "detector.pattern.arm_width_m",
                                       "detector.pattern.arm_half_length_m",
                                       "detector.min_ring_px",
                                       "detector.min_quality",
                                       "detector.level_sigma_deg",
                                       "detector.max_partial_altitude_m",
                                       "tracker.acceleration_noise",
                                       "tracker.climb_noise",
                                       "tracker.turn_noise",
                                       "tracker.start_speed_sigma_mps",
                                       "tracker.gate",
                                       "tracker.restart_count",
                                       "tracker.max_speed_mps",
                                       "tracker.confirm_count",
                                       "tracker.predict_after_s",
                                       "tracker.lost_after_s",
                                       "noise.pose_sigma_m",
                                       "noise.attitude_sigma_deg",
                                       "noise.pose_bias_m",
                                       "noise.attitude_bias_deg",
                                       "still",
                                       "position_by_altitude",
                                       "target_height_m",
                                       "track_yaw",
                                       "altitude_hint",
                                       "hint_sigma_m",
                                       "hint_age_s"};

bool IsOffered(std::string_view key) {
  return std::find(std::begin(kNames), std::end(kNames), key) != std::end(kNames);
}

std::string TextOf(const OptionField& field) {
  return std::visit([](const auto* value) { return fmt::format("{}", *value); }, field.value);
}

}  // namespace

ConsoleOptionList ReplayOptions(const LandingPipelineOptions& options) {
  LandingPipelineOptions named = options;
  ConsoleOptionList list;
  for (const OptionField& field : FieldsOf(named)) {
    if (!IsOffered(field.key)) continue;
    list.options.push_back({std::string(kPrefix) + field.key, TextOf(field),
                            std::string(field.unit), std::string(field.meaning)});
  }
  return list;
}

LandingPipelineOptions WithSettings(LandingPipelineOptions options,
                                    const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) {
    const std::string_view name = std::string_view(setting).substr(0, setting.find('='));
    if (!name.starts_with(kPrefix) || !IsOffered(name.substr(kPrefix.size()))) {
      throw InputError(fmt::format("{}: no option that the page may change", name));
    }
    SetOption(setting.substr(kPrefix.size()), &options);
  }
  RequireValid(options);
  return options;
}

}  // namespace kestrel
