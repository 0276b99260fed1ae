// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/messages/lens_json.h"

#include <nlohmann/json.hpp>

namespace kestrel {
namespace {

using Json = nlohmann::json;

Json EstimateJson(const ConsoleLens::Estimate& estimate) {
  return {{"focal_px", estimate.focal_px}, {"focal_sigma_px", estimate.focal_sigma_px},
          {"rms_px", estimate.rms_px},     {"views", estimate.views},
          {"model", estimate.model},       {"warnings", estimate.warnings}};
}

}  // namespace

Json Message(const ConsoleLens& lens) {
  return {{"kind", "lens"},
          {"running", lens.is_running},
          {"board", lens.board},
          {"error", lens.error},
          {"advice", lens.advice},
          {"views", lens.views},
          {"fields", lens.fields},
          {"columns", LensCoverage::kColumns},
          {"left", lens.left},
          {"right", lens.right},
          {"top", lens.top},
          {"bottom", lens.bottom},
          {"near", lens.near},
          {"far", lens.far},
          {"estimate", lens.estimate ? EstimateJson(*lens.estimate) : Json()},
          {"refusal", lens.refusal},
          {"good", lens.is_good},
          {"folder", lens.folder},
          {"saved", lens.saved},
          {"next", lens.next},
          {"save_error", lens.save_error},
          {"exists", lens.exists}};
}

}  // namespace kestrel
