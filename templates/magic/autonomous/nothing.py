"""Stand still: for when our partners need the room."""


class Nothing:
    """The least that an autonomous mode has to have."""

    MODE_NAME = "Nothing"

    def on_enable(self) -> None:
        """Called once when autonomous starts."""

    def on_iteration(self, tm: float) -> None:
        """Called every 20 ms, with the seconds since autonomous started."""

    def on_disable(self) -> None:
        """Called once when autonomous is over."""
