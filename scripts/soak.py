# SPDX-License-Identifier: BSD-3-Clause
"""What the soaks share: a program's memory, processor time and end, from outside."""

import os
import signal
import subprocess
from pathlib import Path

MAX_GROWTH = 0.02  # of memory, after the first quarter


def resident_mb(pid):
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def cpu_seconds(pid):
    """0 of a program that has ended."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except FileNotFoundError:
        return 0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def stop(program):
    """Exit status, or None when it had to be killed."""
    if program.poll() is None:
        program.send_signal(signal.SIGINT)
    try:
        return program.wait(timeout=20)
    except subprocess.TimeoutExpired:
        program.kill()
        program.wait()
        return None


def memory_report(memory):
    """In words what 'memory', MB from second to second, did after its first quarter; whether it did not grow."""
    warm = memory[len(memory) // 4:]
    if not warm:
        return "memory not known", False
    quarter = max(1, len(warm) // 4)
    growth = max(warm[-quarter:]) / max(warm[:quarter]) - 1
    text = f"memory {warm[0]:.1f} to {warm[-1]:.1f} MB ({100 * growth:+.1f} %)"
    return text, growth < MAX_GROWTH
