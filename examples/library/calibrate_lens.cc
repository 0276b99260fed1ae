// SPDX-License-Identifier: BSD-3-Clause
// Estimates the lens of a camera from its views of the landing pattern.
//
//   calibrate_lens views/
#include <iostream>
#include <vector>

#include "kestrel/error.h"
#include "kestrel/lens_calibration.h"
#include "kestrel/open_source.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: calibrate_lens views/\n";
    return 2;
  }
  try {
    std::vector<kestrel::LensImage> images;
    const auto source = kestrel::OpenSource({argv[1]});
    for (kestrel::Frame frame; source->Next(&frame);) {
      images.push_back({frame.name, frame.image.clone()});
    }
    const kestrel::LensCalibration lens = kestrel::CalibrateLens(images, {});
    std::cout << lens.views.size() << " of " << images.size() << " views used, focal length "
              << lens.intrinsics.fx_px << " px, " << lens.fit.RootMeanSquare() << " px left\n";
    for (const std::string& warning : lens.warnings) std::cout << warning << "\n";
  } catch (const kestrel::InputError& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
