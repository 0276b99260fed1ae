# SPDX-License-Identifier: BSD-3-Clause
"""Hosts on one machine that hear each other by a radio: it loses, delays and cuts.

Every host is a network namespace with one interface, a TAP device, whose Ethernet frames come to this
process; Radio passes them on. Nothing leaves the machine. Needs root (CAP_NET_ADMIN, CAP_SYS_ADMIN).
"""

import ctypes
import fcntl
import heapq
import os
import random
import select
import struct
import subprocess
import threading
import time

CLONE_NEWNET = 0x40000000
TUNSETIFF = 0x400454CA
IFF_TAP, IFF_NO_PI = 0x0002, 0x1000
INTERFACE = "radio0"
MAX_FRAME = 65536

_libc = ctypes.CDLL(None, use_errno=True)


def _check(result, what):
    if result != 0:
        error = ctypes.get_errno()
        raise OSError(error, f"{what}: {os.strerror(error)}")


class Host:
    """A network namespace; it is gone with the last process in it and close()."""

    def __init__(self, number):
        self.number = number
        own = os.open("/proc/thread-self/ns/net", os.O_RDONLY)
        try:
            _check(_libc.unshare(CLONE_NEWNET), "unshare")
            try:
                self.namespace = os.open("/proc/thread-self/ns/net", os.O_RDONLY)
                self.tap = self._open_tap()
            finally:
                _check(_libc.setns(own, CLONE_NEWNET), "setns")
        finally:
            os.close(own)
        for command in (
            "link set lo up",
            f"link set {INTERFACE} address 02:00:00:00:00:{number:02x}",
            f"address add 10.0.0.{number}/24 dev {INTERFACE}",
            f"link set {INTERFACE} up",
        ):
            self.run(["ip", *command.split()]).check_returncode()

    @staticmethod
    def _open_tap():
        tap = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
        fcntl.ioctl(tap, TUNSETIFF, struct.pack("16sH22x", INTERFACE.encode(), IFF_TAP | IFF_NO_PI))
        return tap

    def enter(self):
        """For the child process that becomes a program of this host."""
        _check(_libc.setns(self.namespace, CLONE_NEWNET), "setns")

    def run(self, command):
        return subprocess.run(command, preexec_fn=self.enter, capture_output=True, text=True)

    def sent_bytes(self):
        """That left by the interface since it is there, headers of Ethernet and IP included."""
        line = self.run(["cat", "/proc/net/dev"]).stdout.split(f"{INTERFACE}:")[1].splitlines()[0]
        return int(line.split()[8])

    def close(self):
        os.close(self.tap)
        os.close(self.namespace)


class Radio:
    """Passes frames on between hosts, until close(). Its attributes may be changed at any time."""

    def __init__(self, count, seed=1):
        self.hosts = [Host(number) for number in range(1, count + 1)]
        self.loss = 0.0  # of each frame, at each receiver
        self.delay_s = 0.0
        self.hears = lambda receiver, sender: True  # by the hosts' numbers
        self._random = random.Random(seed)
        self._on_the_way = []
        self._count = 0
        self._is_over = False
        self._thread = threading.Thread(target=self._relay, daemon=True)
        self._thread.start()

    def _relay(self):
        by_tap = {host.tap: host for host in self.hosts}
        while not self._is_over:
            now = time.monotonic()
            wait = min(0.1, max(0.0, self._on_the_way[0][0] - now)) if self._on_the_way else 0.1
            for tap in select.select(list(by_tap), [], [], wait)[0]:
                self._take(by_tap[tap])
            while self._on_the_way and self._on_the_way[0][0] <= time.monotonic():
                _, _, receiver, frame = heapq.heappop(self._on_the_way)
                self._write(receiver, frame)

    def _take(self, sender):
        frame = os.read(sender.tap, MAX_FRAME)
        is_for_all = frame[0] & 1
        for receiver in self.hosts:
            if receiver is sender or not (is_for_all or frame[5] == receiver.number):
                continue
            if not self.hears(receiver.number, sender.number) or self._random.random() < self.loss:
                continue
            self._count += 1
            heapq.heappush(
                self._on_the_way, (time.monotonic() + self.delay_s, self._count, receiver, frame)
            )

    @staticmethod
    def _write(receiver, frame):
        try:
            os.write(receiver.tap, frame)
        except OSError:
            pass  # lost: the interface is down or its queue is full

    def close(self):
        self._is_over = True
        self._thread.join()
        for host in self.hosts:
            host.close()


def obstacle():
    """Why this process cannot make hosts; empty where it can."""
    try:
        Host(1).close()
    except (OSError, subprocess.CalledProcessError) as error:
        return str(error)
    return ""
