// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/replay_options.h"

#include <algorithm>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

// The prefix of a pipeline's options in `kestrel config`, and the options that may be changed.
struct OfferedOptions {
  std::string_view prefix;
  std::span<const std::string_view> names;

  bool Has(std::string_view key) const {
    return std::find(names.begin(), names.end(), key) != names.end();
  }
};

constexpr std::string_view kLandingNames[] = {"detector.pattern.outer_diameter_m",
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

constexpr std::string_view kHuntNames[] = {"detector.min_pixels",
                                           "detector.max_roundness_error",
                                           "detector.max_circularity_error",
                                           "detector.outline_tolerance",
                                           "detector.outline_tolerance_px",
                                           "detector.max_gap",
                                           "detector.max_cut_off_gap",
                                           "detector.max_outside",
                                           "detector.min_outline_share",
                                           "detector.ground_tolerance",
                                           "detector.ground_tolerance_m",
                                           "detector.center_sigma_px",
                                           "detector.radius_sigma_px",
                                           "map.gate",
                                           "map.new_density",
                                           "map.min_separation_m",
                                           "map.drift_noise",
                                           "map.shared_sigma_m",
                                           "map.detection_probability",
                                           "map.false_probability",
                                           "map.removal_probability",
                                           "map.confirm_count",
                                           "still",
                                           "ground_height_m",
                                           "is_ground_flat",
                                           "ground_sigma_m",
                                           "readout_s",
                                           "track_count",
                                           "pose_sigma_m",
                                           "attitude_sigma_deg"};

constexpr OfferedOptions Offered(const LandingPipelineOptions& /*options*/) {
  return {"landing.", kLandingNames};
}
constexpr OfferedOptions Offered(const HuntPipelineOptions& /*options*/) {
  return {"hunt.", kHuntNames};
}

std::string TextOf(const OptionField& field) {
  return std::visit([](const auto* value) { return fmt::format("{}", *value); }, field.value);
}

template <class Options>
ConsoleOptionList ListOf(Options options) {
  const OfferedOptions offered = Offered(options);
  ConsoleOptionList list;
  for (const OptionField& field : FieldsOf(options)) {
    if (!offered.Has(field.key)) continue;
    list.options.push_back({std::string(offered.prefix) + field.key, TextOf(field),
                            std::string(field.unit), std::string(field.meaning)});
  }
  return list;
}

template <class Options>
Options Changed(Options options, const std::vector<std::string>& settings) {
  const OfferedOptions offered = Offered(options);
  for (const std::string& setting : settings) {
    const std::string_view name = std::string_view(setting).substr(0, setting.find('='));
    if (!name.starts_with(offered.prefix) || !offered.Has(name.substr(offered.prefix.size()))) {
      throw InputError(fmt::format("{}: no option that the page may change", name));
    }
    SetOption(setting.substr(offered.prefix.size()), &options);
  }
  RequireValid(options);
  return options;
}

}  // namespace

ConsoleOptionList ReplayOptions(const LandingPipelineOptions& options) { return ListOf(options); }

ConsoleOptionList ReplayOptions(const HuntPipelineOptions& options) { return ListOf(options); }

LandingPipelineOptions WithSettings(LandingPipelineOptions options,
                                    const std::vector<std::string>& settings) {
  return Changed(std::move(options), settings);
}

HuntPipelineOptions WithSettings(HuntPipelineOptions options,
                                 const std::vector<std::string>& settings) {
  return Changed(options, settings);
}

}  // namespace kestrel
