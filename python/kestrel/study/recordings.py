# SPDX-License-Identifier: BSD-3-Clause
"""The recordings of a study: which there are, whether they have changed, and how a worker gets one
that lies elsewhere."""
import glob
import hashlib
import itertools
import json
import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

import fsspec

from .errors import StudyError, one_line

_BAGS = (".bag", ".mcap", ".db3")
_VIDEOS = (".avi", ".mkv", ".mov", ".mp4")
_IMAGES = (".bmp", ".jpeg", ".jpg", ".pgm", ".png", ".ppm", ".tif", ".tiff")
# Keys of a file's description that change with the file, by file system.
_IDENTITY = ("size", "mtime", "LastModified", "last_modified", "ETag", "etag", "checksum")
_URL = re.compile(r"\w[\w+.-]*://")
_MAGIC = re.compile(r"[*?[]")


@dataclass
class Recording:
    """A recording, or a simulated flight that a worker makes."""

    name: str
    path: str  # absolute, or a URL, or the command that simulates it
    simulation: Optional[dict] = None  # monte_carlo.simulated_flight
    mark: str = ""  # its fingerprint, when the study met it

    def is_remote(self):
        """Returns whether a worker fetches it."""
        return self.simulation is None and is_url(self.path)

    def seed(self):
        """Returns the seed of a simulated flight, else None."""
        return self.simulation["seed"] if self.simulation else None


def is_url(text):
    """Returns whether a text is a URL, as sftp://host/flights."""
    return bool(_URL.match(text))


def _is_recording(path):
    if path.is_dir():
        return (path / "mav0").is_dir() or (path / "metadata.yaml").is_file()
    return path.suffix in _BAGS


def _in_folder(folder):
    """Yields the recordings below a folder: EuRoC folders and bags."""
    if _is_recording(folder):
        yield folder
    elif folder.is_dir():
        for entry in sorted(folder.iterdir()):
            if not entry.name.startswith("."):
                yield from _in_folder(entry)


def _is_single(path):
    """Returns whether a path is one source that is no recording folder or bag."""
    if path.is_file():
        return path.suffix in _VIDEOS
    return path.is_dir() and any(entry.suffix.lower() in _IMAGES for entry in path.iterdir()
                                 if not entry.name.startswith("."))


def _root(pattern):
    """Returns the folder of a pattern above its first wildcard."""
    parts = Path(pattern).parts
    return Path(*itertools.takewhile(lambda part: not _MAGIC.search(part), parts))


def _name(path, root):
    """Returns the path below the root; of the root itself its own name."""
    relative = os.path.relpath(path, root)
    return os.path.basename(path) if relative == "." else relative


def _find_local(pattern, base):
    text = os.path.join(base, os.path.expanduser(pattern))
    root = _root(text)
    paths = sorted(Path(path) for path in glob.glob(text, recursive=True)) \
        if _MAGIC.search(text) else [Path(text)]
    if not paths or not paths[0].exists():
        raise StudyError(f"recordings: {pattern}: not there")
    found = [one for path in paths for one in _in_folder(path)] or list(filter(_is_single, paths))
    if not found:
        raise StudyError(f"recordings: {pattern}: no recording, expected EuRoC folders, bags, MCAP "
                         "files, a video or images")
    return [Recording(_name(path, root), os.path.abspath(path)) for path in found]


def _is_folder(system, path):
    if _is_web(system):  # a folder is a page of links, which its description does not tell
        return not path.endswith((*_BAGS, *_VIDEOS)) and system.isdir(path)
    return system.info(path)["type"] == "directory"


def _is_web(system):
    return "http" in system.protocol


def _cause(error):
    """Returns what a file system says of an error; each has errors of its own."""
    if not isinstance(error, FileNotFoundError):
        return one_line(error)
    # A server of HTTP that does not answer looks like a missing file.
    return one_line(error.__cause__) if isinstance(error.__cause__, OSError) else "not there"


def _open_url(url):
    """Returns the file system of a URL and the path on it."""
    try:
        return fsspec.core.url_to_fs(url)
    except Exception as error:
        raise StudyError(f"{url}: {_cause(error)}") from None


def _entries(system, folder):
    """Yields (path, description) of what lies in a remote folder. A web server's page of it has
    links to elsewhere, too."""
    for entry in system.ls(folder, detail=True):
        path = entry["name"].rstrip("/")
        if path.startswith(f"{folder.rstrip('/')}/") and "?" not in path:
            yield path, entry


def _remote_files(system, path):
    """Yields (path, description) of all files of a remote recording. A web server is asked for the
    descriptions one by one: not of images, of which there are many."""
    if not _is_folder(system, path):
        yield path, system.info(path)
        return
    for below, entry in sorted(_entries(system, path), key=lambda pair: pair[0]):
        if entry["type"] != "directory":
            is_asked = _is_web(system) and not below.lower().endswith(_IMAGES)
            yield below, system.info(below) if is_asked else entry
        elif not _is_web(system) or system.exists(below):  # a link upwards looks like a folder
            yield from _remote_files(system, below)


def _remote_folder(system, path):
    """Returns the recordings in a remote folder: itself, or what it holds."""
    entries = {name: entry["type"] for name, entry in _entries(system, path)}
    names = {name.rpartition("/")[2] for name in entries}
    if "mav0" in names or "metadata.yaml" in names:
        return [path]
    return [name for name, kind in sorted(entries.items())
            if name.endswith(_BAGS) or (kind == "directory" and system.exists(f"{name}/mav0"))]


def _find_remote(url):
    system, path = _open_url(url.rstrip("/"))
    host = url.rstrip("/").removesuffix(path.rstrip("/"))
    try:
        if _MAGIC.search(path):
            found = sorted(name.rstrip("/") for name in system.glob(path) if "?" not in name)
            root = path[:_MAGIC.search(path).start()].rpartition("/")[0]
        elif _is_folder(system, path):
            found, root = _remote_folder(system, path), path
        else:
            system.info(path)  # fails where it is not there
            found, root = [path], path
    except Exception as error:
        raise StudyError(f"recordings: {url}: {_cause(error)}") from None
    if not found:
        raise StudyError(f"recordings: {url}: no recording there")
    return [Recording(_name(one, root), host + one) for one in found]


def find_recordings(entries, base):
    """Returns the recordings that a study names.

    entries: paths, globs, URLs, or {"path", "name"}. base: the folder that relative paths are seen
    from. Raises StudyError where one is not there, or two have the same name.
    """
    recordings = {}
    for entry in entries:
        path = entry["path"] if isinstance(entry, dict) else entry
        found = _find_remote(path) if is_url(path) else _find_local(path, base)
        if isinstance(entry, dict) and "name" in entry:
            if len(found) > 1:
                raise StudyError(f"recordings: {path}: {len(found)} recordings, expected one for "
                                 f"the name '{entry['name']}'")
            found[0].name = entry["name"]
        for recording in found:
            other = recordings.setdefault(recording.name, recording)
            if other.path != recording.path:
                raise StudyError(f"recordings: '{recording.name}' is both {other.path} and "
                                 f"{recording.path}; expected {{path: ..., name: ...}} for one")
    return list(recordings.values())


def _files(path):
    """Yields (name below the recording, path) of what the recording consists of, in order."""
    path = Path(path)
    if path.is_file():
        yield path.name, path
        return
    # Results that lie in the folder of a recording are not part of it.
    tops = [path / "mav0", path / "scene.yaml"] if (path / "mav0").is_dir() else [path]
    for top in tops:
        if top.is_file():
            yield top.name, top
        for folder, folders, files in os.walk(top):
            folders.sort()
            for name in sorted(files):
                file = Path(folder, name)
                yield str(file.relative_to(path)), file


def fingerprint(recording):
    """Returns what says that a recording has not changed: names, and sizes and times of all files
    but images, of which a recording has many. Raises StudyError where it cannot be read."""
    digest = hashlib.sha256()
    try:
        if recording.is_remote():
            return _remote_fingerprint(recording.path)
        for name, path in _files(recording.path):
            digest.update(name.encode() + b"\0")
            if path.suffix.lower() not in _IMAGES:
                status = path.stat()
                digest.update(f"{status.st_size} {status.st_mtime_ns}\0".encode())
    except OSError as error:
        raise StudyError(f"{error.filename}: {error.strerror}") from None
    return digest.hexdigest()


def _remote_fingerprint(url):
    system, path = _open_url(url)
    try:
        said = [[name, *(str(described.get(key)) for key in _IDENTITY)]
                for name, described in _remote_files(system, path)]
    except Exception as error:
        raise StudyError(f"{url}: {_cause(error)}") from None
    return hashlib.sha256(json.dumps(said).encode()).hexdigest()


def known_content(recording, store):
    """Returns the hash of a recording's content where nobody must read all of it: of a simulated
    flight, of a URL (what its server says), and of one that has not changed since it was hashed;
    else None. Raises StudyError where the recording cannot be read."""
    if recording.simulation is not None:
        said = json.dumps({**recording.simulation, "command": None}, sort_keys=True)
        return hashlib.sha256(said.encode()).hexdigest()
    recording.mark = fingerprint(recording)
    if recording.is_remote():
        return recording.mark
    return store.content_hash(recording.path, recording.mark)


def content_hash(path):
    """Returns the hash of all that a recording on this computer consists of. Raises StudyError
    where it cannot be read."""
    digest = hashlib.sha256()
    try:
        for name, file in _files(path):
            content = hashlib.sha256(file.read_bytes()) if file.stat().st_size < 1 << 24 \
                else _hash_large(file)
            digest.update(name.encode() + b"\0" + content.digest())
    except OSError as error:
        raise StudyError(f"{error.filename}: {error.strerror}") from None
    return digest.hexdigest()


def _hash_large(file):
    digest = hashlib.sha256()
    with open(file, "rb") as stream:
        while block := stream.read(1 << 22):
            digest.update(block)
    return digest


def fetch(url, folder):
    """Copies the recording of a URL into a folder and returns its path. Raises StudyError."""
    system, path = _open_url(url)
    target = Path(folder) / path.rpartition("/")[2]
    try:
        for name, _ in _remote_files(system, path):
            file = Path(f"{target}{name.removeprefix(path)}")
            file.parent.mkdir(parents=True, exist_ok=True)
            system.get_file(name, str(file))
    except Exception as error:
        raise StudyError(f"{url}: {_cause(error)}") from None
    return target
