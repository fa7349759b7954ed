"""Modules on the CAN bus, by number: pneumatics (CTRE's and REV's) and power distribution."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache, partial
from typing import Any

from . import pneumatics
from .containers import LiveDict, LiveList, Slot, ValueList
from .fields import INITIALIZED, group
from .kinds import BOOL, FLOAT
from .paths import join
from .shared_rows import CHANNELS, DISTRIBUTION, HUB_COMPRESSOR, PCM_COMPRESSOR

MODULES = 63  # CAN device numbers 0 to 62; the HAL does not check beyond


def solenoid(module: Any, path: str, channel: int) -> LiveDict:
    """Return a solenoid of a pneumatics module; it is initialized when its module is."""

    def build() -> dict[str, Slot]:
        def watch(fire: Callable[[], None]) -> object:
            return pneumatics.watch_solenoid(module, channel, fire)

        get, put = pneumatics.solenoid(module, channel)
        return {"initialized": INITIALIZED.slot(module), "value": Slot(get, put, BOOL, watch, unset=False)}

    return LiveDict(path, build)


def distribution(path: str, module: pneumatics.PowerDistribution) -> LiveDict:
    """Return a power distribution module. Both kinds show the HAL's 24 channels."""

    def build() -> dict[str, Slot]:
        slots = {field.name: field.slot(module) for field in DISTRIBUTION}
        currents = ValueList(join(path, "current"), FLOAT, lambda: CHANNELS, *pneumatics.currents(module))
        slots["current"] = Slot(lambda: currents, None, watch=watch, plain=partial(list, currents))
        # Computed like the HAL's value for the robot.
        slots["total_current"] = Slot(
            lambda: float(sum(currents)),
            None,
            FLOAT,
            watch,
            recorded=False,
            remedy="it is the sum of current: write that",
        )
        return slots

    def watch(fire: Callable[[], None]) -> object:
        return [pneumatics.watch_current(module, i, fire) for i in range(CHANNELS)]

    return LiveDict(path, build)


class ModuleDict(LiveDict):
    """Modules by their CAN number; each appears when the robot has created it.

    :param initialized: returns whether the module with a number was created
    :param make: returns the module with a number
    :param early: the number of a module that can also be read and written before that
    """

    def __init__(
        self, path: str, initialized: Callable[[int], bool], make: Callable[[int], Any], early: int | None = None
    ) -> None:
        super().__init__(path, dict)
        self._initialized, self._make, self._early = initialized, make, early

    def __contains__(self, key: object) -> bool:
        return isinstance(key, int) and 0 <= key < MODULES and self._initialized(key)

    def __iter__(self) -> Iterator[int]:
        return (number for number in range(MODULES) if self._initialized(number))

    def __getitem__(self, key: Any) -> Any:
        if key not in self and (key != self._early or not isinstance(key, int)):
            there = ", ".join(map(str, self)) or "none"
            raise self._unknown(key, f"a module appears when the robot creates it; existing modules: {there}")
        return self._make(key)

    def __setitem__(self, key: Any, value: Any) -> None:
        self[key].assign(value)


class Modules:
    """All CAN modules. Each dict is created once, and is the same object everywhere in the tree."""

    def __init__(self) -> None:
        self._pcm_sim = lru_cache(None)(pneumatics.Pcm)
        self._hub_sim = lru_cache(None)(pneumatics.Hub)
        self._power_sim = lru_cache(None)(pneumatics.PowerDistribution)
        self._hub_solenoids = lru_cache(None)(lambda n: self._solenoids(join("ph", n), self._hub_sim(n), 16))
        self._pcm_solenoids = lru_cache(None)(lambda n: self._solenoids(join("pcm", n), self._pcm_sim(n), 8))
        self._hub_compressor = lru_cache(None)(
            lambda n: group(join("ph_compressor", n), self._hub_sim(n), HUB_COMPRESSOR)
        )
        self._pcm_compressor = lru_cache(None)(
            lambda n: group(join("pcm_compressor", n), self._pcm_sim(n), PCM_COMPRESSOR)
        )
        distributions = lru_cache(None)(lambda n: distribution(join("pdp", n), self._power_sim(n)))
        #: Whether there is a module with a number, and its part of the tree, by the keys there.
        self._parts: dict[str, tuple[Callable[[int], bool], Callable[[int], LiveDict | LiveList]]] = {
            "pcm": (self._has_pcm, self._pcm_solenoids),
            "ph": (self._has_hub, self._hub_solenoids),
            "pcm_compressor": (self._has_pcm, self._pcm_compressor),
            "ph_compressor": (self._has_hub, self._hub_compressor),
            "pdp": (lambda n: pneumatics.exists(self._power_sim(n)), distributions),
        }
        #: The parts by key: dicts of the modules that exist, by number.
        self.by_key = {
            key: ModuleDict(key, *part, early=0 if key == "pdp" else None) for key, part in self._parts.items()
        }
        self.by_key["pcm"] = ModuleDict("pcm", lambda n: self._has_pcm(n) or self._has_hub(n), self._either, early=0)

    def made(self, key: str) -> list[tuple[int, LiveDict | LiveList]]:
        """Return the modules that the robot has made: their numbers, and their parts of the tree.

        :param key: which part of the tree
        """
        exists, part = self._parts[key]
        return [(number, part(number)) for number in range(MODULES) if exists(number)]

    def _has_pcm(self, module: int) -> bool:
        return pneumatics.exists(self._pcm_sim(module))

    def _has_hub(self, module: int) -> bool:
        return pneumatics.exists(self._hub_sim(module))

    def _either(self, module: int) -> LiveList:
        # A PCM and a hub may share a number: the key is the PCM's by history, and also before any is created.
        is_hub = self._has_hub(module) and not self._has_pcm(module)
        return self._hub_solenoids(module) if is_hub else self._pcm_solenoids(module)

    @staticmethod
    def _solenoids(path: str, module: Any, count: int) -> LiveList:
        return LiveList(path, [solenoid(module, join(path, channel), channel) for channel in range(count)])

    @property
    def solenoid(self) -> LiveList:
        """The solenoids of module 0, also before it is created: CTRE's, unless only REV's exists."""
        return self._either(0)

    @property
    def compressor(self) -> LiveDict:
        """The compressor of the robot's first module, CTRE's before REV's; by default that of CTRE's module 0."""
        for key in ("pcm_compressor", "ph_compressor"):
            for number in self.by_key[key]:
                found: LiveDict = self._parts[key][1](number)  # type: ignore[assignment]
                return found
        return self._pcm_compressor(0)

    def initialized(self) -> list[Slot]:
        """Return a slot for each possible module that says whether the robot has created it."""
        return [
            INITIALIZED.slot(make(number))
            for make in (self._pcm_sim, self._hub_sim, self._power_sim)
            for number in range(MODULES)
        ]
