# SPDX-License-Identifier: BSD-3-Clause
"""Errors that a user sees as one line."""


class StudyError(Exception):
    """Input is at fault; the message is one line that names the file, the key or the recording."""


def one_line(text):
    """Returns a message as one line, without what stands before the cause."""
    lines = [line.strip() for line in str(text).splitlines() if line.strip()]
    return lines[-1].removeprefix("kestrel: ") if lines else "no message"
