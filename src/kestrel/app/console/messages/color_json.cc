// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/messages/color_json.h"

#include <utility>

#include <nlohmann/json.hpp>

namespace kestrel {
namespace {

using Json = nlohmann::json;

Json Component(const ColorComponent& component) {
  return {{"weight", component.weight},
          {"hue", component.mean.hue_deg},
          {"saturation", component.mean.saturation},
          {"sigma_hue", component.sigma.hue_deg},
          {"sigma_saturation", component.sigma.saturation},
          {"correlation", component.correlation}};
}

}  // namespace

Json Message(const ConsoleColors& colors) {
  Json components = Json::array();
  for (const ColorComponent& component : colors.components) {
    components.push_back(Component(component));
  }
  return {{"kind", "colors"},
          {"revision", colors.revision},
          {"frames", colors.frames},
          {"most_kept", colors.most_kept},
          {"names", colors.names},
          {"color", colors.color},
          {"marked", colors.marked},
          {"strokes", colors.strokes},
          {"can_redo", colors.can_redo},
          {"histogram", colors.histogram},
          {"cut_hue", colors.cut_hue_deg},
          {"components", std::move(components)},
          {"max_distance", colors.max_distance},
          {"warnings", colors.warnings},
          {"difference", colors.difference},
          {"file", colors.file},
          {"versions", colors.versions},
          {"answer", colors.answer},
          {"refused", colors.is_refused}};
}

Json Message(const ConsoleColorScores& of_color) {
  const ColorScores& scores = of_color.scores;
  Json overlaps = Json::array(), left_outs = Json::array();
  for (const ColorOverlap& overlap : scores.overlaps) {
    overlaps.push_back({{"color", overlap.color}, {"share", overlap.share}});
  }
  for (const ColorScores::LeftOut& left_out : scores.left_outs) {
    left_outs.push_back({{"frame", left_out.frame}, {"recall", left_out.recall}});
  }
  return {{"kind", "color-scores"},
          {"revision", of_color.revision},
          {"color", of_color.color},
          {"wanted", scores.wanted},
          {"recall", scores.recall},
          {"others", scores.others},
          {"false_share", scores.false_share},
          {"overlaps", std::move(overlaps)},
          {"left_outs", std::move(left_outs)}};
}

}  // namespace kestrel
