# SPDX-License-Identifier: BSD-3-Clause
"""Errors that a user sees as one line."""
import traceback


class StudyError(Exception):
    """Input is at fault; the message is one line that names the file, the key or the recording."""


def one_line(text):
    """Returns a message as one line, without what stands before the cause."""
    lines = [line.strip() for line in str(text).splitlines() if line.strip()]
    return lines[-1].removeprefix("kestrel: ") if lines else "no message"


def reason_of(error):
    """Returns (reason, log) of an error: one line, and a traceback where the input is not at
    fault."""
    if isinstance(error, StudyError):
        return str(error), getattr(error, "log", "")
    if isinstance(error, OSError) and error.strerror:
        return error.strerror, ""
    log = "".join(traceback.format_exception(type(error), error, error.__traceback__))
    return f"{type(error).__name__}: {one_line(error)}", log
