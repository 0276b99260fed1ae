# SPDX-License-Identifier: BSD-3-Clause
"""`kestrel study run|report`; docs/study.md."""
import argparse
import logging
import signal
import sys
import time
from pathlib import Path

from .errors import StudyError

_DONE, _INPUT_AT_FAULT, _INTERRUPTED = 0, 1, 130
_SHOW_S = 10  # between two lines of progress where there is no terminal


def _say(text):
    if sys.stderr.isatty():
        print("\r\033[K", end="", file=sys.stderr)
    print(f"kestrel: {text}", file=sys.stderr, flush=True)


class _Progress:
    """A line on stderr that says how far it is: on a terminal always the last."""

    def __init__(self):
        self._start = self._shown = time.monotonic()

    def show(self, done, failed, planned):
        now = time.monotonic()
        is_terminal = sys.stderr.isatty()
        if now - self._shown < (0.2 if is_terminal else _SHOW_S):
            return
        self._shown = now
        words = f"{done} of {planned} units, {failed} failed, {now - self._start:.0f} s"
        if is_terminal:
            print(f"\r\033[Kkestrel: {words}", end="", file=sys.stderr, flush=True)
        else:
            _say(words)


def _run(arguments):
    from .cluster import workers_of
    from .plan import read_plan
    from .run import Runner
    from .store import Store
    plan = read_plan(arguments.study, arguments.set)
    workers = workers_of(arguments.where or plan.where, arguments.workers or plan.workers)
    folder = Path(arguments.output or plan.output)
    with Store(folder) as store:
        store.keep_plan(plan.text, plan.configuration_rows())
        if arguments.retry:
            store.forget_failed()
        runner = Runner(plan, store, workers, _Progress().show, _say)
        runner.run()
        store.export()
        failed = store.count("failed")
    _say(f"{folder}: {runner.planned} units, {failed} failed; `kestrel study report {folder}` says "
         "what they show")
    return _INPUT_AT_FAULT if failed else _DONE


def _report(arguments):
    from . import report
    return report.main([arguments.folder, *arguments.rest])


def _positive(text):
    number = int(text)
    if number < 1:
        raise ValueError
    return number


def _parser():
    parser = argparse.ArgumentParser(
        prog="kestrel study", description="Many recordings, several configurations or versions, on "
        "this computer or on many: what is found, what is missed, what got worse.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="run|report")
    run = commands.add_parser("run", help="do the units that have no result yet")
    run.add_argument("study", metavar="STUDY.yaml")
    run.add_argument("--output", metavar="DIR", help="folder of the results (default: the file's "
                     "`output`, else its name with _study)")
    run.add_argument("--where", help="local, slurm, or a scheduler as tcp://HOST:8786")
    run.add_argument("--workers", type=_positive, metavar="N",
                     help="how many, of local and slurm (default: the cores, the tasks)")
    run.add_argument("--set", action="append", default=[], metavar="KEY=VALUE",
                     help="an option of all configurations; a list [1, 2] is a grid")
    run.add_argument("--retry", action="store_true", help="do the units that failed again, too")
    run.set_defaults(function=_run)
    report = commands.add_parser("report", help="what the results show", add_help=False)
    report.add_argument("folder", metavar="DIR")
    report.add_argument("rest", nargs=argparse.REMAINDER)
    report.set_defaults(function=_report)
    return parser


def _interrupt(number, frame):
    raise KeyboardInterrupt


def main(arguments=None):
    """Runs the command and returns its exit status."""
    arguments = _parser().parse_args(arguments)
    signal.signal(signal.SIGTERM, _interrupt)
    logging.disable(logging.CRITICAL)  # what Dask has to say is told in our words
    try:
        return arguments.function(arguments)
    except StudyError as error:
        _say(error)
    except KeyboardInterrupt:
        _say("interrupted; what is done is kept, the same command goes on")
        return _INTERRUPTED
    return _INPUT_AT_FAULT


if __name__ == "__main__":
    sys.exit(main())
