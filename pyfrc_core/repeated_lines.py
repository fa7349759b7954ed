"""Lines of output that follow each other again and again: each is shown once, with a count."""

from __future__ import annotations


class RepeatedLines:
    """Shortens one output."""

    def __init__(self) -> None:
        self._last = self._held = ""
        self._count = 0
        self._in_line = False

    def feed(self, text: str) -> str:
        """Return the next piece of the output; what may become a repeated line is kept back."""
        *lines, rest = (self._held + text).split("\n")
        shown, self._held = [], ""
        for line in lines:
            if self._in_line:  # the rest of a line that is shown
                self._in_line = False
                shown.append(f"{line}\n")
            elif line and line == self._last:
                self._count += 1
            elif line or not self._count:  # empty lines between the repeated ones are left out, too
                shown.append(f"{self._said()}{line}\n")
                self._last = line or self._last
        if rest and (self._last.startswith(rest) and not self._in_line):
            self._held = rest
        elif rest:
            shown.append(self._said() + rest)
            self._last, self._in_line = "", True
        return "".join(shown)

    def end(self) -> str:
        """Return what was kept back, and how often the last line was repeated."""
        held, self._held = self._held, ""
        return self._said() + held

    def _said(self) -> str:
        count, self._count = self._count, 0
        return f"(the line above: {count} time{'s' * (count > 1)} more)\n" if count else ""


def shortened(text: str) -> str:
    """Return a whole output, shortened."""
    lines = RepeatedLines()
    return lines.feed(text) + lines.end()
