// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/console/messages/settings_state.h"
#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/flight/session/flight_report.h"

namespace kestrel {

// The few options that a pilot changes in the field: camera, exposure and target. They are saved to
// the configuration file and used by the next start. Used by one thread.
class FieldSettings {
 public:
  // 'file': the configuration file; empty: none. 'given': settings of the command line, as
  // "key=value". 'options': what both give.
  FieldSettings(std::string file, std::vector<std::string> given, const KestrelOptions& options);

  // Returns the settings with the values that the next start would use.
  ConsoleSettings State() const;

  // Saves settings, each as "key=value"; the state reports success, or the refusal: no file, a key
  // that is not one of these or that the command line gives, a value that the command line would
  // refuse, a UAV that is armed.
  ConsoleSettings Save(const std::vector<std::string>& settings,
                       const std::optional<AutopilotState>& autopilot);

 private:
  void SaveOrThrow(const std::vector<std::string>& settings,
                   const std::optional<AutopilotState>& autopilot);
  bool IsGiven(const std::string& key) const;

  std::string file_;
  std::vector<std::string> given_;
  KestrelOptions options_;
};

}  // namespace kestrel
