"""A package index on this machine, with small wheels under the robot's tags, and a file as the robot's Python."""

from __future__ import annotations

import gzip
import hashlib
import os
import re
import threading
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from random import Random
from urllib.parse import unquote

from written_files import zip_of

from pyfrc_core.season import CURRENT

DOWNLOADS = CURRENT.downloads
#: The tags of wheels for the season's robots, and of wheels in Python alone.
ROBOT_TAGS = f"{DOWNLOADS.abi}-{DOWNLOADS.abi}-{DOWNLOADS.platforms[0]}"
ANY_TAGS = "py3-none-any"
#: The version of WPILib that the fake packages have.
WPILIB = CURRENT.packages.wpilib
#: How large the file is with the robot's Python.
PYTHON_SIZE = 300_000


class PackageIndex:
    """The usual index (``simple``), WPILib's of the season (``robot``), and the robot's Python, in a directory."""

    def __init__(self, directory: Path, port: int = 0) -> None:
        self.directory = directory
        #: Each request as its path and its header ``Range``.
        self.requests: list[tuple[str, str]] = []
        self.python = directory / DOWNLOADS.python_url.rpartition("/")[2]
        self.python.parent.mkdir(parents=True, exist_ok=True)
        self.python.write_bytes(gzip.compress(Random(1).randbytes(PYTHON_SIZE), mtime=0))
        self._server = ThreadingHTTPServer(("127.0.0.1", port), partial(_Handler, self))
        self._thread = threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.02})
        self._thread.start()
        self.url = f"http://127.0.0.1:{self._server.server_port}"

    def close(self) -> None:
        """Stop serving: from now on, connections are refused."""
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def add(
        self, name: str, version: str, requires: Iterable[str] = (), tags: str = ANY_TAGS, index: str = "simple"
    ) -> Path:
        """Add a wheel, and return its file."""
        return add_wheel(self.directory / index / name, name, version, requires, tags)

    def add_wpilib(self, version: str = WPILIB) -> None:
        """Add packages that depend on each other as WPILib's do."""
        machine = DOWNLOADS.marker_machine
        self.add(
            "robotpy",
            version,
            [
                f"wpilib=={version}",
                "robotpy-cli",
                f'only-on-desktops; platform_machine != "{machine}"',
                f'robotpy-commands-v2=={version}; extra == "commands2"',
                f'robotpy-apriltag=={version}; extra == "apriltag"',
            ],
        )
        self.add("robotpy-cli", "1.0")
        self.add("robotpy-commands-v2", version)
        needs = [
            f"robotpy-hal=={version}",
            f'only-on-robots; platform_machine == "{machine}"',
            'only-on-windows; sys_platform == "win32"',
            'only-on-old-pythons; python_version < "3.14"',
        ]
        self.add("only-on-robots", "1.0")
        # As the real ones: the wheels on the usual index are not for robots.
        for package in ("wpilib", "robotpy-hal"):
            self.add(package, version, needs, f"{DOWNLOADS.abi}-{DOWNLOADS.abi}-manylinux_2_39_aarch64")
        self.add("wpilib", version, needs, ROBOT_TAGS, "robot")
        for package in ("robotpy-hal", "robotpy-apriltag"):
            self.add(package, version, (), ROBOT_TAGS, "robot")

    def environment(self, home: Path) -> dict[str, str]:
        """Return the environment of a computer that has these indexes."""
        return {
            "HOME": str(home),
            "USERPROFILE": str(home),
            "PIP_CONFIG_FILE": os.devnull,
            "PIP_INDEX_URL": f"{self.url}/simple",
            "PIP_FIND_LINKS": "",
            "PIP_NO_CACHE_DIR": "1",
            "PYFRC_SYNC_INDEX": f"{self.url}/robot",
            "PYFRC_SYNC_PYTHON": f"{self.url}/{self.python.name}",
        }

    def served(self, path: str) -> bytes | None:
        """Return what is at a path: a file, or a page with links to the files of a package."""
        file = self.directory / unquote(path).strip("/")
        if file.is_file():
            return file.read_bytes()
        if not file.is_dir():
            return None
        links = (
            f'<a href="{each.name}#sha256={hashlib.sha256(each.read_bytes()).hexdigest()}">{each.name}</a>'
            for each in sorted(file.iterdir())
        )
        return f"<!DOCTYPE html><html><body>{' '.join(links)}</body></html>".encode()


@contextmanager
def package_index(directory: Path) -> Iterator[PackageIndex]:
    """Serve an index from a directory."""
    index = PackageIndex(directory)
    try:
        yield index
    finally:
        index.close()


class _Handler(BaseHTTPRequestHandler):
    """Serves files as large hosts do: with a mark of their version, and from a byte on."""

    protocol_version = "HTTP/1.1"

    def __init__(self, index: PackageIndex, *args: object) -> None:
        self._index = index
        super().__init__(*args)  # type: ignore[arg-type]

    def do_GET(self) -> None:
        wanted = self.headers.get("Range", "")
        self._index.requests.append((unquote(self.path), wanted))
        content = self._index.served(self.path)
        if content is None:
            self.send_error(404)
            return
        tag = f'"{hashlib.sha256(content).hexdigest()[:16]}"'
        begin = re.fullmatch(r"bytes=(\d+)-", wanted)
        start = int(begin[1]) if begin and self.headers.get("If-Range", tag) == tag else 0
        if start >= len(content) > 0:
            self.send_error(416)
            return
        self.send_response(206 if start else 200)
        if start:
            self.send_header("Content-Range", f"bytes {start}-{len(content) - 1}/{len(content)}")
        is_page = not unquote(self.path).endswith((".whl", ".gz", ".ipk"))
        self.send_header("Content-Type", "text/html" if is_page else "application/octet-stream")
        self.send_header("Content-Length", str(len(content) - start))
        self.send_header("ETag", tag)
        self.end_headers()
        self.wfile.write(content[start:])

    def log_message(self, *_: object) -> None:
        """Print nothing."""


def add_wheel(
    directory: Path,
    name: str,
    version: str,
    requires: Iterable[str] = (),
    tags: str = ANY_TAGS,
    files: Mapping[str, str] | None = None,
) -> Path:
    """Write a wheel with these files, or with one module, and return its file."""
    directory.mkdir(parents=True, exist_ok=True)
    module = name.replace("-", "_")
    file = directory / f"{module}-{version}-{tags}.whl"
    requires = list(requires)
    extras = {found[1] for each in requires if (found := re.search(r"extra == [\"'](\w+)", each))}
    about = [
        "Metadata-Version: 2.1",
        f"Name: {name}",
        f"Version: {version}",
        *(f"Provides-Extra: {each}" for each in sorted(extras)),
        *(f"Requires-Dist: {each}" for each in requires),
    ]
    pure = str(tags == ANY_TAGS).lower()
    content = zip_of(
        {
            **({f"{module}/__init__.py": f"__version__ = {version!r}\n"} if files is None else files),
            f"{module}-{version}.dist-info/METADATA": "\n".join([*about, "", ""]),
            f"{module}-{version}.dist-info/WHEEL": f"Wheel-Version: 1.0\nGenerator: tests\nRoot-Is-Purelib: {pure}\n"
            f"Tag: {tags}\n",
            f"{module}-{version}.dist-info/RECORD": "",
        }
    )
    file.write_bytes(content)
    return file
