"""What is in a page that `--page` has written."""

from __future__ import annotations

import base64
import gzip
import json
import re
from pathlib import Path
from typing import Any


def run_in(page: Path) -> dict[str, Any]:
    """Return the run in a page, as the page's own code reads it."""
    match = re.search(r'<script type="application/gzip" id="run">([A-Za-z0-9+/=]+)</script>', page.read_text("utf-8"))
    assert match is not None
    found: dict[str, Any] = json.loads(gzip.decompress(base64.b64decode(match[1])))
    return found
