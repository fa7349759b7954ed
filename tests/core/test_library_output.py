"""Libraries' lines are removed from a robot's output, in whatever pieces it comes, and nothing else is."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pyfrc_core.compat.library_output import LibraryOutput

#: As the libraries print them: wpilib 2026.2.2, robotpy-navx 2026.0.1, phoenix6 26.3.
PRINTED = """\
Not loading CameraServerShared
the robot's own line
Default SimulationPeriodic() method... Override me!
Instantiating NavX on roboRIO MXP Port.
NavX: Library for FRC
navX-Sensor SimDevice created.
NavX: Connected.
NavX: Board Type 33 (unknown)
NavX: firmware version 4.1.500
NavX: startup initialization and startup calibration complete.
NavX: onboard startup calibration complete.
NavX: Yaw angle auto-reset to 0.0 due to startup calibration.
NavX: is my gyro
[phoenix] CANbus Connected: sim
[phoenix] CANbus Network Up: sim
[phoenix] Library initialization is complete.
\t
[phoenix-diagnostics] Server 2026.3.0 (May 22 2026, 21:24:16) running on port: 1250
\t
[phoenix-diagnostics] Server 2026.3.0 (May 22 2026, 21:24:16) first attempt to open server failed at port 1250
\t
Could not transmit CAN Frame.
\ttalon fx 22 ("") Apply Config
\t
NT: Listening on NT3 port 1735, NT4 port 5810
NT: NT4 server socket error: address already in use
DataLog: Logging to '/x/FRC.wpilog' (1.0 GiB free space)
Default TeleopPeriodic() method... Override me!
speed: Not loading CameraServerShared
"""
SHOWN = """\
the robot's own line
NavX: is my gyro
Could not transmit CAN Frame.
\ttalon fx 22 ("") Apply Config
\t
NT: NT4 server socket error: address already in use
Default TeleopPeriodic() method... Override me!
speed: Not loading CameraServerShared
"""


def test_the_lines_of_libraries_are_removed_and_no_others() -> None:
    assert LibraryOutput().of_whole(PRINTED) == SHOWN


@given(st.lists(st.integers(0, len(PRINTED)), max_size=12))
def test_it_does_not_matter_in_which_pieces_they_come(cuts: list[int]) -> None:
    ends = [0, *sorted(cuts), len(PRINTED)]
    output = LibraryOutput()
    shown = "".join(output.feed(PRINTED[begin:end]) for begin, end in pairwise(ends))
    assert shown + output.end() == SHOWN


@given(st.lists(st.text(alphabet="Nav X:\t\n[phDefault", max_size=6)))
def test_what_a_robot_prints_is_complete(pieces: list[str]) -> None:
    output = LibraryOutput()
    assert "".join(map(output.feed, pieces)) + output.end() == "".join(pieces)


def test_a_method_that_the_robot_does_not_have_is_named_once() -> None:
    output = LibraryOutput()
    line = "Default TeleopPeriodic() method... Override me!\n"
    assert output.of_whole(line) == line
    assert output.of_whole(f"{line}Default TestPeriodic() method... Override me!\n{line}") == (
        "Default TestPeriodic() method... Override me!\n"
    )


@pytest.mark.parametrize("prompt", ["(Pdb) ", "which one? ", "\t"])
def test_a_prompt_is_shown_at_once(prompt: str) -> None:
    assert LibraryOutput().feed(prompt) == prompt


def test_the_beginning_of_a_line_is_shown_at_the_latest_when_the_output_ends() -> None:
    output = LibraryOutput()
    assert output.feed("Nav") == ""
    assert output.flush() == "Nav"
    assert output.feed("X: Connected.\n") == "X: Connected.\n"  # its beginning is on the screen
    assert output.feed("NavX: Connected.\n") == ""
