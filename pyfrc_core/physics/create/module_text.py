"""Assemble the text of a Python module: its imports, names, set-up code and loop code."""

from __future__ import annotations

import re
from keyword import kwlist
from unicodedata import normalize

from ...wpi import source
from .motors import Motor
from .survey import Encoder


class ModuleText:
    """The parts of a module while it is assembled."""

    def __init__(self) -> None:
        self.imports: set[str] = set()
        self.sims: set[str] = set()
        #: The names from `pyfrc.physics.can_motors`, and whether WPILib's motors are used.
        self.from_can_motors: set[str] = set()
        self.needs_motors = False
        self.numbers: list[str] = []
        self.setup: list[str] = []
        self.update: list[str] = []
        # In capitals, like the constants at the top. An attribute "top" would make a second TOP_SPEED.
        taken = ("physics_controller", "drivetrain", "update_sim", "top", *kwlist)
        self._taken: set[str] = {name.upper() for name in taken}

    def name(self, wanted: str) -> str:
        """Return an unused attribute name."""
        # Normalized as by Python's parser: "arm²" is arm2.
        letters = normalize("NFKC", normalize("NFKC", wanted).lower())
        plain = re.sub("_+", "_", "".join(letter if f"_{letter}".isidentifier() else "_" for letter in letters))
        plain = plain.strip("_") or "device"
        plain = plain if plain.isidentifier() else f"device_{plain}"
        number, name = 1, plain
        while name.upper() in self._taken:
            number += 1
            name = f"{plain}_{number}"
        self._taken.add(name.upper())
        return name

    def motor(self, motor: Motor, wanted: str) -> str:
        """Add the set-up of a motor; return the expression for its output."""
        name = self.name(wanted)
        assert motor.channel is not None
        self.simulate(name, source.pwm(motor.channel))
        return source.power_of_pwm(f"self.{name}")

    def encoder(self, encoder: Encoder, wanted: str, units: str) -> str:
        """Add the set-up of an encoder; return its name."""
        name = self.name(wanted)
        simulation = source.encoder(encoder.channels, encoder.index)
        self.sims.add(simulation.name)
        self.setup.append(f"self.{name} = EncoderShaft({simulation.made}, {units})")
        return name

    def simulate(self, name: str, simulation: source.SimulationCode) -> None:
        """Add the simulation of a device, as an attribute of this name."""
        self.sims.add(simulation.name)
        self.setup.append(f"self.{name} = {simulation.made}")
