// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/bag_arguments.h"

#include <fmt/format.h>

namespace kestrel {

void BagArguments::AddTo(CLI::App* command) {
  command
      ->add_option("--topic", topics,
                   "Topic of a bag: the images, where it has several cameras, or the poses")
      ->type_name("NAME")
      ->take_all();
  command->add_flag("--arrival-times", use_arrival_times,
                    "Take the times at which a bag recorded its messages instead of their stamps");
}

RecordingChoice BagArguments::Recording(const std::vector<std::string>& sources,
                                        PixelFormat format) const {
  return {.sources = sources,
          .format = format,
          .bag = {topics, use_arrival_times,
                  [](const std::string& text) { fmt::print(stderr, "kestrel: {}\n", text); }}};
}

}  // namespace kestrel
