"""The picture under the field, scaled to the size at which it is seen.

Tk can make pictures larger or smaller by whole factors only; here each of the screen's pixels takes the picture's
nearest one. Only what is to be seen is made, so that one can come near a large picture.
"""

from __future__ import annotations

import tkinter as tk
from operator import itemgetter
from pathlib import Path

from ....errors import SettingsError
from ..models.viewport import Viewport
from . import theme as colors

_WHERE = "sim/config.json: pyfrc.field.image"


class FieldImage:
    """A picture stretched over the whole field.

    :raises SettingsError: when Tk cannot read it
    """

    def __init__(self, root: tk.Misc, file: Path) -> None:
        try:
            picture = tk.PhotoImage(master=root, file=str(file))
        except tk.TclError as wrong:
            raise SettingsError(
                f"the window cannot show {file.name!r}: {wrong}",
                where=_WHERE,
                remedy="Save the picture as PNG (any drawing program can), and name that file.",
            ) from None
        self._root = root
        self.width, self.height = picture.width(), picture.height()
        # The carpet shows through transparent parts.
        whole = tk.PhotoImage(master=root, width=self.width, height=self.height)
        whole.put(colors.CARPET, to=(0, 0, self.width, self.height))
        root.tk.call(str(whole), "copy", str(picture), "-compositingrule", "overlay")
        data = root.tk.call(str(whole), "data", "-format", "ppm")
        pixels = _pixels(data if isinstance(data, bytes) else str(data).encode("latin-1"))
        size = 3 * self.width
        self._rows = [pixels[start : start + size] for start in range(0, len(pixels), size)]

    def seen(self, view: Viewport) -> tuple[tk.PhotoImage, int, int] | None:
        """Return the visible part of the picture, and its top left pixel; None when nothing is visible."""
        left, top = view.to_screen(0, 0)
        right, bottom = view.to_screen(view.field_width, view.field_height)
        columns = range(max(round(left), 0), min(round(right), view.width))
        rows = range(max(round(top), 0), min(round(bottom), view.height))
        if not columns or not rows:
            return None
        across, down = self.width / (right - left), self.height / (bottom - top)
        taken = [3 * min(max(int((x + 0.5 - left) * across), 0), self.width - 1) for x in columns]
        pick = itemgetter(*(slice(byte, byte + 3) for byte in [*taken, taken[-1]]))  # two or more: returns a tuple
        lines: list[bytes] = []
        last, line = -1, b""
        for y in rows:
            number = min(max(int((y + 0.5 - top) * down), 0), self.height - 1)
            if number != last:
                last, line = number, b"".join(pick(self._rows[number])[:-1])
            lines.append(line)
        header = b"P6 %d %d 255\n" % (len(columns), len(rows))
        image = tk.PhotoImage(master=self._root, data=header + b"".join(lines), format="PPM")
        return image, columns[0], rows[0]


def _pixels(ppm: bytes) -> bytes:
    """Return the pixels of a picture in Tk's PPM format: after three lines of header, three bytes each."""
    return ppm.split(b"\n", 3)[3]
