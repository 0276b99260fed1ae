// SPDX-License-Identifier: BSD-3-Clause
// Lists all AprilTags of the family tag36h11 in an image.
//
//   list_tags photo.jpg
#include <iostream>

#include "kestrel/detect_tags.h"
#include "kestrel/image_file.h"

int main(int /*argc*/, char** argv) {
  for (const auto& tag : kestrel::DetectTags(kestrel::ReadGrayImage(argv[1]), {"tag36h11"})) {
    std::cout << tag.family << " " << tag.id << " at " << tag.corners_px[0].transpose() << " px\n";
  }
}
