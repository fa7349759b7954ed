"""A camera's server: a stream of pictures over HTTP, as robots have it."""

from __future__ import annotations

import struct
import threading
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer


def picture(width: int = 32, height: int = 24) -> bytes:
    """Return a picture: browsers show any kind in such a stream."""
    rows = b"".join(b"\0" + bytes([0, 120, 200]) * width for _ in range(height))

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


class _Camera(BaseHTTPRequestHandler):
    is_over = threading.Event()

    def do_GET(self) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=next")
        self.end_headers()
        data = picture()
        part = b"--next\r\nContent-Type: image/png\r\nContent-Length: %d\r\n\r\n%s\r\n" % (len(data), data)
        with suppress(OSError):
            while True:
                self.wfile.write(part)
                self.wfile.flush()
                if self.is_over.wait(0.1):
                    return

    def log_message(self, format: str, *args: object) -> None:
        pass


@contextmanager
def camera() -> Iterator[str]:
    """Serve a stream, and return its host and port."""
    _Camera.is_over.clear()
    server = ThreadingHTTPServer(("127.0.0.1", 0), _Camera)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"127.0.0.1:{server.server_address[1]}"
    finally:
        _Camera.is_over.set()
        server.shutdown()
        server.server_close()
