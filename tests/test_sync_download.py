"""Downloads from servers that send something else than they were asked for."""

from __future__ import annotations

import hashlib
import threading
from collections.abc import Callable, Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.request import Request

import pytest
from loops import for_each

from pyfrc_core.sync import download
from pyfrc_core.sync.download import Download, Downloader, DownloadError

CONTENT = b"0123456789" * 10
SHA256 = hashlib.sha256(CONTENT).hexdigest()
Answer = Callable[[BaseHTTPRequestHandler], None]


class Server:
    """A server with one behavior."""

    def __init__(self) -> None:
        self.answer: Answer
        server = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                server.answer(self)

            def log_message(self, *_: object) -> None:
                """Print nothing."""

        self._http = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._thread = threading.Thread(target=self._http.serve_forever, kwargs={"poll_interval": 0.02})
        self._thread.start()
        self.url = f"http://127.0.0.1:{self._http.server_port}/six.whl"

    def close(self) -> None:
        self._http.shutdown()
        self._http.server_close()
        self._thread.join()

    def sends(self, status: int, content: bytes, **headers: str) -> None:
        def answer(request: BaseHTTPRequestHandler) -> None:
            request.send_response(status)
            for name, value in headers.items():
                request.send_header(name.replace("_", "-"), value)
            request.end_headers()
            request.wfile.write(content)

        self.answer = answer


@pytest.fixture
def server() -> Iterator[Server]:
    server = Server()
    yield server
    server.close()


def get(wanted: Download) -> bool:
    return Downloader().get(wanted, lambda there, total: None)


def test_a_part_that_was_not_asked_for_is_not_believed(server: Server, tmp_path: Path) -> None:
    wanted = Download("six 1.0", server.url, tmp_path / "six.whl", SHA256)
    server.sends(206, CONTENT[50:], Content_Range="bytes 50-99/100")
    with pytest.raises(DownloadError, match=r"^127\.0\.0\.1 sent another part of six 1\.0 than was asked for"):
        get(wanted)
    wanted.part.write_bytes(CONTENT[:10])
    with pytest.raises(DownloadError, match="sent another part"):
        get(wanted)
    assert list(tmp_path.iterdir()) == []
    wanted.part.write_bytes(CONTENT[:50])
    assert get(wanted)
    assert wanted.to.read_bytes() == CONTENT


@pytest.mark.parametrize(
    ("size", "why"),
    [(10, r"six 1\.0 from 127\.0\.0\.1 has another content"), (0, r"127\.0\.0\.1 sends more than six 1\.0 can have")],
)
def test_more_than_a_file_can_have_is_not_stored(
    server: Server, tmp_path: Path, size: int, why: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(download, "_MAX_BYTES", 99)
    server.sends(200, CONTENT)
    with pytest.raises(DownloadError, match=why):
        get(Download("six 1.0", server.url, tmp_path / "six.whl", "0" * 64, size))
    assert list(tmp_path.iterdir()) == []


@for_each(
    "there, to, followed",
    [
        ("https://a.invalid/x", "http://a.invalid/x", False),
        ("https://a.invalid/x", "ftp://a.invalid/x", False),
        ("http://a.invalid/x", "ftp://a.invalid/x", False),
        ("https://a.invalid/x", "https://b.invalid/x", True),
        ("http://a.invalid/x", "https://a.invalid/x", True),
        ("http://a.invalid/x", "http://b.invalid/x", True),
    ],
)
def test_no_redirection_leaves_an_encrypted_connection(there: str, to: str, followed: bool) -> None:
    handler, empty = download._SafeRedirects(), Request(there).headers
    if followed:
        request = handler.redirect_request(Request(there), None, 302, "", empty, to)
        assert request is not None
        assert request.full_url == to
    else:
        with pytest.raises(DownloadError, match=f"^{there} redirects to {to}, which is not encrypted"):
            handler.redirect_request(Request(there), None, 302, "", empty, to)


def test_a_file_of_the_servers_size_is_kept_where_no_hash_is_known(server: Server, tmp_path: Path) -> None:
    wanted = Download("Python 3", server.url, tmp_path / "python.ipk")
    server.sends(200, CONTENT, Content_Length="100")
    wanted.to.write_bytes(bytes(100))
    assert get(wanted) is False
    assert wanted.to.read_bytes() == bytes(100)
    wanted.to.write_bytes(bytes(99))
    with pytest.raises(DownloadError, match=r"^127\.0\.0\.1 sent something else than Python 3"):
        get(wanted)  # which is no archive, and another time
    assert [each.name for each in tmp_path.iterdir()] == ["python.ipk"]


def test_how_often_a_lost_connection_is_tried_again(server: Server, tmp_path: Path) -> None:
    """Not without any byte, and else three times in a row without a byte more."""
    asked: list[str] = []

    def cut(*pieces: int) -> Answer:
        sizes = iter(pieces)

        def answer(request: BaseHTTPRequestHandler) -> None:
            asked.append(request.headers.get("Range", ""))
            begin = int(asked[-1].removeprefix("bytes=").removesuffix("-") or 0)
            request.send_response(206 if begin else 200)
            request.send_header("Content-Range", f"bytes {begin}-99/100")
            request.send_header("Content-Length", str(100 - begin))
            request.end_headers()
            request.wfile.write(CONTENT[begin : begin + next(sizes, 0)])

        return answer

    wanted = Download("six 1.0", server.url, tmp_path / "six.whl", SHA256)
    lost = r"^six 1\.0 cannot be downloaded from 127\.0\.0\.1: the connection was lost\n"
    server.answer = cut(0)
    with pytest.raises(DownloadError, match=lost):
        get(wanted)
    server.answer = cut(10, 0, 10)
    with pytest.raises(DownloadError, match=lost):
        get(wanted)
    server.answer = cut(0, 0, 80)
    assert get(wanted)
    assert wanted.to.read_bytes() == CONTENT
    ranges = ["", "", "bytes=10-", "bytes=10-", *["bytes=20-"] * 3, *["bytes=20-"] * 3]
    assert asked == ranges


def test_redirections_are_looked_at(server: Server, tmp_path: Path) -> None:
    server.sends(302, b"", Location="ftp://127.0.0.1/six.whl")
    with pytest.raises(DownloadError, match="redirects to ftp://"):
        get(Download("six 1.0", server.url, tmp_path / "six.whl", SHA256))
