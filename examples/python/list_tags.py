# SPDX-License-Identifier: BSD-3-Clause
"""Lists all AprilTags of the family tag36h11 in an image: list_tags.py photo.jpg"""
import sys

import kestrel

for tag in kestrel.detect_tags(kestrel.read_image(sys.argv[1]), ["tag36h11"]):
    print(tag.family, tag.id, "at", tag.corners_px[0].round(1), "px")
