# SPDX-License-Identifier: BSD-3-Clause
"""ARM's code on this machine, under qemu-user: in the system that `packaging/build DIST arm64` has made and built in; DIST is an
environment variable; if it is not set trixie, which Raspberry Pi OS is."""

import os
import subprocess
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent
DIST = os.environ.get("DIST", "trixie")
ROOT = PROJECT / f"build/package_root/{DIST}-arm64"
SOURCE = "/build/kestrel"
BUILD = f"{SOURCE}/build/release"
EMULATOR = "qemu-aarch64-static"
NEEDED = ["libgtest-dev:arm64", "libgmock-dev:arm64", "libbenchmark-dev:arm64"]
MOUNT = """set -e
root=$1; cache=$2; shared=$3; shift 3
mkdir -p "$root/ccache" "$root/build/shared"
mount -t proc proc "$root/proc"
mount --rbind /dev "$root/dev"
mount --bind "$cache" "$root/ccache"
[ ! -d "$shared" ] || mount --bind -o ro "$shared" "$root/build/shared"
exec env --ignore-environment HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive CCACHE_DIR=/ccache \\
  CCACHE_BASEDIR=/build/kestrel CCACHE_SLOPPINESS=locale chroot "$root" "$@"
"""


def inside(*command, **options):
    """Runs a command in that system; what it mounts and starts ends with it."""
    cache = subprocess.run(["ccache", "--get-config", "cache_dir"], check=True, capture_output=True, text=True).stdout.strip()
    return subprocess.run(["unshare", "--mount", "--pid", "--fork", "--kill-child", "bash", "-c", MOUNT, "bash", ROOT, cache,
                           PROJECT.parent / "shared", *command], **options)


def build(targets):
    """Builds targets there, of the same objects that the packages have, linked without libkestrel: names of functions
    are those of the program."""
    if not (ROOT / BUILD[1:] / "CMakeCache.txt").exists():
        sys.exit(f"arm64: no build for ARM in build/package_root, expected `packaging/build {DIST} arm64` before")
    inside("sh", "-c", f"dpkg -s {' '.join(NEEDED)} >/dev/null 2>&1 || "
           f"{{ apt-get -qq update && apt-get -qq -y --no-install-recommends install {' '.join(NEEDED)}; }}", check=True,
           stdout=subprocess.DEVNULL)
    configured = inside("cmake", "-DKESTREL_BUILD_TESTS=ON", "-DKESTREL_BUILD_BENCHMARKS=ON", "-DKESTREL_SHARED_LIBRARY=OFF", BUILD,
                        capture_output=True, text=True)
    if configured.returncode != 0:
        sys.exit(configured.stderr)
    inside("ninja", "-C", BUILD, *targets, check=True, stdout=subprocess.DEVNULL)
