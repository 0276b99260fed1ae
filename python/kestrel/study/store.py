# SPDX-License-Identifier: BSD-3-Clause
"""The results of a study: one SQLite file, and tables as CSV that are the same to the byte whatever
the order in which the units were done, and however often the study was interrupted."""
import csv
import fcntl
import os
import sqlite3
from pathlib import Path

from .errors import StudyError

DATABASE = "study.db"
PLAN = "study.yaml"
# The columns of each table, in order; `key` names a unit of work (plan.py). `state` is 'done',
# 'failed', or 'old': done for an earlier plan, and not part of the study.
TABLES = {
    "unit": {"key": "TEXT PRIMARY KEY", "recording": "TEXT", "piece": "INTEGER",
             "configuration": "TEXT", "version": "TEXT", "task": "TEXT", "seed": "INTEGER",
             "state": "TEXT", "reason": "TEXT", "frames": "INTEGER", "path": "TEXT"},
    "bin": {"key": "TEXT", "quantity": "TEXT", "lower": "REAL", "upper": "REAL",
            "frames": "INTEGER", "found": "INTEGER", "false": "INTEGER", "error_sum": "REAL",
            "error_squares": "REAL", "nees_sum": "REAL", "nees_count": "INTEGER",
            "quality_sum": "REAL"},
    "summary": {"key": "TEXT", "name": "TEXT", "value": "REAL"},
    "worst": {"key": "TEXT", "rank": "INTEGER", "time_ns": "INTEGER", "frame": "TEXT",
              "what": "TEXT", "value": "REAL"},
    "detection": {"key": "TEXT", "time_ns": "INTEGER", "frame": "TEXT", "found": "INTEGER",
                  "false": "INTEGER", "error_m": "REAL"},
    "resource": {"key": "TEXT", "seconds": "REAL", "cpu_s": "REAL", "memory_mb": "REAL",
                 "frame_ms_median": "REAL", "frame_ms_p99": "REAL", "worker": "TEXT",
                 "log": "TEXT"},
}
# The options that the study ran with, complete, in the plan's order (`place`). `arguments`: JSON, a
# list of words. `text`: every option of the command, as YAML.
_CONFIGURATION = {"name": "TEXT", "version": "TEXT", "task": "TEXT", "place": "INTEGER",
                  "command": "TEXT", "arguments": "TEXT", "text": "TEXT"}
# The resources of a unit differ from run to run.
EXPORTED = [table for table in TABLES if table != "resource"]
_IS_CONFIGURATION = "configuration=? AND version=? AND task=?"  # of a unit
# The recordings whose content was hashed already, by what says that they have not changed.
_HASHES = ("CREATE TABLE IF NOT EXISTS content"
           "(source TEXT PRIMARY KEY, fingerprint TEXT, hash TEXT)")


def _locked(folder):
    """Returns a handle that keeps other studies out of a folder as long as it is open."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(handle)
        raise StudyError(f"{folder}: another study runs into it") from None
    return handle


def _create_table(connection, table, columns, more=""):
    described = ", ".join(f'"{name}" {kind}' for name, kind in columns.items())
    connection.execute(f'CREATE TABLE IF NOT EXISTS "{table}" ({described}{more})')


def _create(connection):
    for table, columns in TABLES.items():
        _create_table(connection, table, columns)
        if table != "unit":
            connection.execute(f'CREATE INDEX IF NOT EXISTS "{table}_key" ON "{table}"(key)')
    _create_table(connection, "configuration", _CONFIGURATION,
                  ", PRIMARY KEY (name, version, task)")
    connection.execute(_HASHES)
    connection.execute("CREATE TEMP TABLE planned(key TEXT PRIMARY KEY)")
    connection.commit()


class Store:
    """The file study.db of a folder. One process writes; others may read meanwhile.

    Raises StudyError where the file cannot be read or written.
    """

    def __init__(self, folder):
        self.folder = Path(folder)
        self.path = self.folder / DATABASE
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self._lock = _locked(self.folder)
            self._connection = sqlite3.connect(self.path, isolation_level="DEFERRED")
            # A kill between two commits costs what was not committed, never the file.
            self._connection.execute("PRAGMA journal_mode=WAL")
            self._connection.execute("PRAGMA synchronous=NORMAL")
            _create(self._connection)
        except (OSError, sqlite3.Error) as error:
            raise StudyError(f"{self.path}: {error}") from None

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        self.close()

    def has(self, key, path):
        """Returns whether a unit of the plan has a result; path: where its recording is now."""
        self._connection.execute("INSERT OR IGNORE INTO planned VALUES (?)", (key,))
        found = self._connection.execute("SELECT state, path FROM unit WHERE key=?",
                                         (key,)).fetchone()
        if found and (found[0] == "old" or found[1] != path):
            state = "done" if found[0] == "old" else found[0]
            self._connection.execute("UPDATE unit SET state=?, path=? WHERE key=?",
                                     (state, path, key))
        return bool(found)

    def retire(self):
        """Sets what an earlier plan has done and this one does not ask for aside, as 'old': it is
        in no table, and is not done again when a plan asks for it."""
        other = "key NOT IN (SELECT key FROM planned)"
        self._connection.execute(f"UPDATE unit SET state='old' WHERE state='done' AND {other}")
        self._forget(f"state='failed' AND {other}")
        self._connection.execute(
            "DELETE FROM configuration WHERE NOT EXISTS (SELECT 1 FROM unit WHERE state!='old' "
            "AND configuration=name AND unit.version=configuration.version "
            "AND unit.task=configuration.task)")
        self.commit()

    def count(self, state):
        """Returns how many units are in a state."""
        query = "SELECT count(*) FROM unit WHERE state=?"
        return self._connection.execute(query, (state,)).fetchone()[0]

    def add(self, unit, result):
        """Adds the result of a unit, unless it is there: a result that came twice counts once.

        unit: a dict with the columns of `unit` but state, reason and frames. result: what
        `unit.run_unit` returns. `commit` makes it last.
        """
        row = {**unit, "state": result["state"], "reason": result.get("reason", ""),
               "frames": result.get("frames", 0)}
        try:
            added = self._insert("unit", [row], "INSERT OR IGNORE").rowcount
            if not added:
                return
            key = unit["key"]
            summary = sorted(result.get("summary", {}).items())
            self._insert("summary", [{"key": key, "name": name, "value": value}
                                     for name, value in summary])
            for table, rows in (("bin", "bins"), ("worst", "worst"), ("detection", "detections")):
                self._insert(table, [{**row, "key": key} for row in result.get(rows, [])])
            self._insert("resource", [{**result.get("resource", {}), "key": key}])
        except sqlite3.Error as error:
            raise self._write_error(error) from None

    def _insert(self, table, rows, how="INSERT"):
        columns = TABLES.get(table, _CONFIGURATION)
        names = ", ".join(f'"{name}"' for name in columns)
        places = ", ".join("?" * len(columns))
        values = [tuple(row.get(name) for name in columns) for row in rows]
        return self._connection.executemany(
            f'{how} INTO "{table}" ({names}) VALUES ({places})', values)

    def _write_error(self, error):
        return StudyError(f"{self.path}: {error}; what it has is kept, the same command goes on")

    def commit(self):
        """Makes what was added last."""
        try:
            self._connection.commit()
        except sqlite3.Error as error:
            raise self._write_error(error) from None

    def forget_failed(self):
        """Removes the units that failed, so that they are tried again."""
        self._forget("state='failed'")
        self.commit()

    def _forget(self, condition, values=()):
        forgotten = f"SELECT key FROM unit WHERE {condition}"
        for table in reversed(TABLES):
            self._connection.execute(f'DELETE FROM "{table}" WHERE key IN ({forgotten})', values)

    def keep_plan(self, text, configurations):
        """Keeps STUDY.yaml beside the results, for the gates of the report, and the options that
        the study runs with.

        configurations: rows of the table `configuration`. Results of other options of the same name
        are set aside: they leave the tables.
        """
        try:
            (self.folder / PLAN).write_text(text)
        except OSError as error:
            raise StudyError(f"{self.folder / PLAN}: {error.strerror}") from None
        try:
            for row in configurations:
                self._set_others_aside(row)
            self._insert("configuration", configurations, "INSERT OR REPLACE")
        except sqlite3.Error as error:
            raise self._write_error(error) from None
        self.commit()

    def _set_others_aside(self, configuration):
        """Sets the results of a configuration that had other options aside."""
        names = tuple(configuration[column] for column in ("name", "version", "task"))
        before = self._connection.execute(
            "SELECT arguments, text FROM configuration WHERE name=? AND version=? AND task=?",
            names).fetchone()
        if before in (None, (configuration["arguments"], configuration["text"])):
            return
        self._connection.execute(
            f"UPDATE unit SET state='old' WHERE state='done' AND {_IS_CONFIGURATION}", names)
        self._forget(f"state='failed' AND {_IS_CONFIGURATION}", names)

    def content_hash(self, source, fingerprint):
        """Returns the hash of a recording that has not changed since, or None."""
        query = "SELECT hash FROM content WHERE source=? AND fingerprint=?"
        row = self._connection.execute(query, (source, fingerprint)).fetchone()
        return row[0] if row else None

    def remember_content(self, source, fingerprint, content_hash):
        """Keeps the hash of a recording, until its fingerprint is another."""
        self._connection.execute("INSERT OR REPLACE INTO content VALUES (?, ?, ?)",
                                 (source, fingerprint, content_hash))

    def export(self):
        """Writes the tables as TABLE.csv beside study.db, all but `resource`, in an order that
        depends on the rows alone."""
        shown = "WHERE key IN (SELECT key FROM unit WHERE state!='old') ORDER BY"
        for table in EXPORTED:
            # `rowid` within a unit: its worker's order.
            order = "recording, piece, configuration, version, task, seed, key" \
                if table == "unit" else "key, rowid"
            self._export(table, TABLES[table], f"{shown} {order}")
        self._export("configuration", _CONFIGURATION, "ORDER BY place, name, version, task")

    def _export(self, table, columns, which):
        names = ", ".join(f'"{name}"' for name in columns)
        rows = self._connection.execute(f'SELECT {names} FROM "{table}" {which}')
        part = self.folder / f"{table}.csv.part"
        try:
            with open(part, "w", newline="") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow(columns)
                writer.writerows(rows)
            os.replace(part, self.folder / f"{table}.csv")
        except OSError as error:
            part.unlink(missing_ok=True)
            raise StudyError(f"{self.folder / f'{table}.csv'}: {error.strerror}") from None

    def close(self):
        """Closes the file, which then is one file. What was not committed is lost."""
        try:
            self._connection.rollback()
            self._connection.execute("PRAGMA journal_mode=DELETE")
        except sqlite3.Error:
            pass  # a reader has it open: the journal stays beside it and is read with it
        self._connection.close()
        os.close(self._lock)
