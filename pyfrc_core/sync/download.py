"""Download a file: in pieces, with progress, and from where an earlier attempt ended.

Hand-written on `urllib`, since what is public of pip downloads neither single files nor the robot's Python, and
starts again after a lost connection.
"""

from __future__ import annotations

import errno
import gzip
import os
import re
import shutil
import ssl
import urllib.error
import urllib.request
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from http.client import HTTPException, HTTPMessage, HTTPResponse
from importlib import import_module
from pathlib import Path
from typing import IO, Literal
from urllib.parse import urlsplit
from urllib.request import url2pathname

from .._version import __version__
from ..errors import PyfrcError
from ..file_hash import hash_file

_PIECE = 1 << 16
#: Seconds without any byte after which a connection counts as lost.
_TIMEOUT = 30.0
#: How often a lost connection is tried again in a row, without a byte more.
_RETRIES = 3
_RANGE = re.compile(r"bytes (\d+)-\d+/(\d+)")
#: The size of the largest file whose size is unknown.
_MAX_BYTES = 1 << 30
#: How the files begin that have the robot's Python: gzip, and Debian's archives.
_ARCHIVES = (b"\x1f\x8b", b"!<arch>\n")


class DownloadError(PyfrcError):
    """A file could not be downloaded."""


@dataclass(frozen=True)
class Download:
    """A file to download.

    :param what:   what it is, for messages
    :param url:    its address: ``http:``, ``https:``, or ``file:``
    :param to:     where it is to be
    :param sha256: its hash; None if unknown
    :param size:   its size in bytes; 0 if unknown
    :param named_by: the variable of the environment that names the address, if one does
    """

    what: str
    url: str
    to: Path
    sha256: str | None = None
    size: int = 0
    named_by: str | None = None

    @property
    def part(self) -> Path:
        """The file with the bytes that have arrived."""
        return self.to.with_name(f".{self.to.name}.part")

    @property
    def version_file(self) -> Path:
        """The file with the server's mark of the version of which they are."""
        return self.to.with_name(f".{self.to.name}.part-of")


class _SafeRedirects(urllib.request.HTTPRedirectHandler):
    """Follows redirections, but not from an encrypted connection to another one."""

    def redirect_request(
        self, req: urllib.request.Request, fp: IO[bytes], code: int, msg: str, headers: HTTPMessage, newurl: str
    ) -> urllib.request.Request | None:
        if urlsplit(newurl).scheme not in ("https", req.type):
            raise DownloadError(
                f"{req.full_url} redirects to {newurl}, which is not encrypted: nothing was taken from there",
                remedy="Use another network, or another address: docs/reference/sync.md.",
            )
        return super().redirect_request(req, fp, code, msg, headers, newurl)


class Downloader:
    """Downloads files.

    :param use_certifi: whether to trust the certificates of the package certifi instead of the system's
    """

    def __init__(self, use_certifi: bool = False) -> None:
        context = ssl.create_default_context(cafile=_certificates(use_certifi))
        self._opener = urllib.request.build_opener(urllib.request.HTTPSHandler(context=context), _SafeRedirects)

    def get(self, wanted: Download, advanced: Callable[[int, int | None], None]) -> bool:
        """Download a file. What an earlier attempt has received is kept, and the file appears only when complete.

        Without a hash, a file that is there and as large as the server's is kept. Return whether one was downloaded.

        :param advanced: is called with the bytes that are there, and with all; None if the server does not say
        :raises DownloadError: if it cannot be reached, or has another hash than it should
        """
        wanted.to.parent.mkdir(parents=True, exist_ok=True)
        try:
            if urlsplit(wanted.url).scheme == "file":
                _copy(wanted)
            elif not self._receive(wanted, advanced):
                return False
            self._check(wanted)
            wanted.part.replace(wanted.to)
        except OSError as error:
            raise cannot_write(error, wanted.to) from None
        wanted.version_file.unlink(missing_ok=True)
        return True

    def _receive(self, wanted: Download, advanced: Callable[[int, int | None], None]) -> bool:
        """Receive the rest of a file. Return False if the file is there already, as large as the server's."""
        failures = 0
        while True:
            before = _size(wanted.part)
            try:
                state = self._receive_once(wanted, advanced)
                if state != "lost":
                    return state == "complete"
                why = "the connection was lost"
            except urllib.error.HTTPError as refused:
                raise _refused(wanted, refused) from None
            except (urllib.error.URLError, HTTPException, ssl.SSLError, TimeoutError, ConnectionError) as lost:
                why = _reason(lost)
            failures = 0 if _size(wanted.part) > before else failures + 1
            if failures >= _RETRIES or _size(wanted.part) == 0:
                raise _unreachable(wanted, why)

    def _receive_once(
        self, wanted: Download, advanced: Callable[[int, int | None], None]
    ) -> Literal["complete", "lost", "there already"]:
        """Receive until the end or the loss of the connection."""
        try:
            response, asked = self._open(wanted, _size(wanted.part))
        except urllib.error.HTTPError as refused:
            if refused.code != 416:
                raise
            refused.close()  # the part is not the beginning of what the server has now
            wanted.part.unlink()
            response, asked = self._open(wanted, 0)
        with response:
            there, total = 0, None
            if response.status == 206:
                partial = _RANGE.match(response.headers.get("Content-Range", ""))
                if partial is None or not asked or int(partial[1]) != asked:
                    raise _wrong(wanted, f"{_host(wanted)} sent another part of {wanted.what} than was asked for")
                there, total = asked, int(partial[2])
            else:
                length = response.headers.get("Content-Length", "")
                total = int(length) if length.isdecimal() else None
                if wanted.sha256 is None and total is not None and _size(wanted.to) == total:
                    wanted.part.unlink(missing_ok=True)
                    return "there already"
                version = response.headers.get("ETag", "") or response.headers.get("Last-Modified", "")
                wanted.version_file.write_text(version, "utf-8")
            with wanted.part.open("r+b" if there else "wb") as part:
                part.truncate(there)
                part.seek(there)
                while piece := response.read(_PIECE):
                    there += len(piece)
                    part.write(piece)
                    if wanted.size and there > wanted.size:
                        return "complete"  # its hash differs
                    if there > _MAX_BYTES:
                        raise _wrong(wanted, f"{_host(wanted)} sends more than {wanted.what} can have")
                    advanced(there, total)
                part.flush()
                os.fsync(part.fileno())
        return "complete" if total is None or there == total else "lost"

    def _open(self, wanted: Download, there: int) -> tuple[HTTPResponse, int]:
        """Return the response, and from which byte on the file was asked for."""
        headers = {"User-Agent": f"pyfrc/{__version__}", "Accept-Encoding": "identity"}
        if there:
            version = ""
            with suppress(OSError):
                version = wanted.version_file.read_text("utf-8")
            if version and not version.startswith("W/"):
                headers |= {"Range": f"bytes={there}-", "If-Range": version}
            elif wanted.sha256 is not None:  # it shows whether the parts fit together
                headers["Range"] = f"bytes={there}-"
        request = urllib.request.Request(wanted.url, headers=headers)
        return self._opener.open(request, timeout=_TIMEOUT), there if "Range" in headers else 0

    def _check(self, wanted: Download) -> None:
        """Check the received bytes, and remove them if they are wrong.

        :raises DownloadError: if they are
        """
        if wanted.sha256 is None:
            fits = _is_complete_archive(wanted.part)
            wrong = f"{_host(wanted)} sent something else than {wanted.what}"
            remedy = "A network may ask for a login first: open a web page, then run pyfrc sync again."
        else:
            fits = hash_file(wanted.part)[0] == wanted.sha256
            wrong = f"{wanted.what} from {_host(wanted)} has another content than it should have (its SHA-256 differs)"
            remedy = "Run pyfrc sync again. If it stays so, the file was replaced: pyfrc sync --upgrade"
        if not fits:
            raise _wrong(wanted, wrong, remedy)


def _wrong(wanted: Download, text: str, remedy: str = "Run pyfrc sync again, or in another network.") -> DownloadError:
    """Remove what has arrived, and return the error for it."""
    wanted.part.unlink(missing_ok=True)
    wanted.version_file.unlink(missing_ok=True)
    return DownloadError(text, remedy=remedy)


def cannot_write(error: OSError, to: Path) -> OSError | DownloadError:
    """Return the error of a full disk as one sentence; others as they are."""
    if error.errno in (errno.ENOSPC, getattr(errno, "EDQUOT", None)):
        return DownloadError(f"the disk is full: {to}", remedy="Free some space, and run pyfrc sync again: it goes on.")
    return error


def _certificates(use_certifi: bool) -> str | None:
    """Return the file with the certificates to trust; None: the system's."""
    if not use_certifi:
        return os.environ.get("PIP_CERT") or None
    try:
        return str(import_module("certifi").where())
    except ImportError:
        remedy = "Install it: python -m pip install certifi"
        raise DownloadError("--use-certifi needs the package certifi", remedy=remedy) from None


def _size(file: Path) -> int:
    try:
        return file.stat().st_size
    except OSError:
        return 0


def _is_complete_archive(file: Path) -> bool:
    """Return whether a file is a complete archive, as far as can be known without its hash."""
    with file.open("rb") as stream:
        if not stream.read(8).startswith(_ARCHIVES):
            return False
    if not file.name.endswith(".gz.part"):
        return True
    try:
        with gzip.open(file) as content:
            while content.read(1 << 20):
                pass
    except (OSError, EOFError, ValueError):
        return False
    return True


def _host(wanted: Download) -> str:
    return urlsplit(wanted.url).hostname or "the directory"


def _reason(error: BaseException) -> str:
    reason = getattr(error, "reason", error)
    if isinstance(reason, ssl.SSLCertVerificationError):
        return f"its certificate could not be verified ({reason.verify_message})"
    if isinstance(reason, TimeoutError):
        return "it did not respond in time"
    if isinstance(reason, OSError) and reason.strerror:
        return reason.strerror
    return str(reason) or type(reason).__name__


def _copy(wanted: Download) -> None:
    file = url2pathname(urlsplit(wanted.url).path)
    try:
        shutil.copyfile(file, wanted.part)
    except (FileNotFoundError, IsADirectoryError):
        remedy = _other_address(wanted) or "Run pyfrc sync again."
        raise DownloadError(f"{wanted.what} is not at {file}", remedy=remedy) from None


def _other_address(wanted: Download) -> str | None:
    """Return what to do if nothing is at an address that the user has named."""
    return f"The variable {wanted.named_by} names this address: correct it, or unset it." if wanted.named_by else None


def _unreachable(wanted: Download, why: str) -> DownloadError:
    remedy = "Connect this computer to the internet, and run pyfrc sync again: it goes on where it ended."
    if "certificate" in why:
        remedy = "Try: pyfrc sync --use-certifi. docs/reference/sync.md has more about certificates."
    return DownloadError(f"{wanted.what} cannot be downloaded from {_host(wanted)}: {why}", remedy=remedy)


def _refused(wanted: Download, refused: urllib.error.HTTPError) -> DownloadError:
    refused.close()
    if refused.code == 404 and (correct := _other_address(wanted)):
        return DownloadError(f"{wanted.what} is not at {wanted.url}", remedy=correct)
    if refused.code == 404:
        remedy = "Run pyfrc sync --upgrade for versions that are there now. Other addresses: docs/reference/sync.md."
        return DownloadError(f"{wanted.what} is no longer at {wanted.url}", remedy=remedy)
    text = f"{wanted.what} cannot be downloaded from {_host(wanted)}: HTTP {refused.code} {refused.reason}"
    return DownloadError(text, remedy="Run pyfrc sync again later: it goes on where it ended.")
