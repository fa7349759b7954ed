"""The tree's dicts and lists: they are Python's own to all code, their values are elsewhere, errors name the place."""

from __future__ import annotations

import decimal
import json
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import hal
import numpy as np
import pytest
import wpilib
from loops import for_each

from pyfrc_core.hal import HalData, devices_exist, existing_devices
from pyfrc_core.hal.containers import NOT_SET, LiveDict, Slot, ValueList, plain, stored
from pyfrc_core.hal.kinds import INT32, UnknownKey, WrongIndex, WrongType, WrongValue, number
from pyfrc_core.hal.reset import forget_what_stays


class Store:
    """Values that are elsewhere, and a dict and a list of them."""

    def __init__(self) -> None:
        self.values: dict[str, Any] = {"speed": 0.5, "count": 2, "const": 7}
        self.numbers = [1, 2, 3]
        self.built = 0
        self.changes = 0
        self.tree = LiveDict("place", self.slots)
        self.list = ValueList("place.list", INT32, lambda: len(self.numbers), self.numbers.__getitem__, self.put)

    def slots(self) -> dict[str, Slot]:
        self.built += 1
        return {
            "speed": Slot(lambda: self.values["speed"], self.setter("speed"), number(-1, 1), unset=NOT_SET),
            "count": Slot(lambda: self.values["count"], self.setter("count"), INT32),
            "alias": Slot(lambda: self.values["count"], self.setter("count"), INT32, canonical="count"),
            "const": Slot(lambda: self.values["const"], None, remedy="leave it"),
            "list": Slot(lambda: self.list, None),
            "own": stored(),
        }

    def setter(self, key: str) -> Callable[[Any], None]:
        return lambda value: self.values.__setitem__(key, value)

    def put(self, index: int, value: Any) -> None:
        self.numbers[index] = value


@pytest.fixture
def store() -> Store:
    return Store()


# -- dicts -------------------------------------------------------------------------------------------------------------


@for_each(
    "do, error, message",
    [
        (lambda tree: tree["speeed"], UnknownKey, "place.speeed: there is no key 'speeed' in place"),
        (lambda tree: tree[["speed"]], UnknownKey, "there is no key ['speed'] in place"),
        (lambda tree: tree.__setitem__("speeed", 1), UnknownKey, "did you mean 'speed'? There is: alias, const, count"),
        (lambda tree: tree.__delitem__("speed"), UnknownKey, "place.speed: a key of hal_data cannot be removed"),
        (lambda tree: tree.clear(), UnknownKey, "place.speed: a key of hal_data cannot be removed"),
        (lambda tree: tree.setdefault("none", 1), UnknownKey, "there is no key 'none' in place"),
        (lambda tree: tree.__setitem__("const", 1), WrongValue, "place.const: cannot be written"),
        (lambda tree: tree.__setitem__("const", 1), WrongValue, "leave it"),
        (lambda tree: tree.__setitem__("speed", 2), WrongValue, "place.speed: "),
        (lambda tree: tree.__setitem__("list", 3), WrongType, "place.list: expected a list, not a int"),
        (lambda tree: tree.assign([1]), WrongType, "place: expected a dict, not a list"),
        (lambda tree: tree.register("none", print), UnknownKey, "there is no key 'none' in place"),
    ],
)
def test_errors_of_a_dict_name_the_place(
    do: Callable[[LiveDict], object], error: type[Exception], message: str, store: Store
) -> None:
    with pytest.raises(error) as caught:
        do(store.tree)
    assert message in str(caught.value)
    assert store.values == {"speed": 0.5, "count": 2, "const": 7}


# -- lists -------------------------------------------------------------------------------------------------------------


@for_each(
    "do, error, message",
    [
        (lambda it: it[3], WrongIndex, "place.list[3]: there is no entry 3, the list has 3\n  use 0 to 2"),
        (lambda it: it[-4], WrongIndex, "there is no entry -4, the list has 3"),
        (lambda it: it["a"], WrongType, "place.list: expected a list index, not 'a' (str)"),
        (lambda it: it.__setitem__(3, 1), WrongIndex, "there is no entry 3"),
        (lambda it: it.__setitem__(-1, "x"), WrongType, "place.list[2]: expected"),
        (lambda it: it.__setitem__(slice(0, 2), [1]), WrongValue, "place.list: 1 values do not fit 2 entries"),
        (lambda it: it.assign([1, 2, 3, 4]), WrongValue, "place.list: 4 values are too many for 3 entries"),
        (lambda it: it.assign("abc"), WrongType, "place.list: expected a list, not a str"),
        (lambda it: it.assign({1}), WrongType, "place.list: expected a list, not a set"),
        (lambda it: it.append(1), WrongType, "place.list: the list has a fixed length and order"),
        (lambda it: it.pop(), WrongType, "the list has a fixed length"),
        (lambda it: it.sort(key=None), WrongType, "the list has a fixed length"),
        (lambda it: it.__delitem__(0), WrongType, "the list has a fixed length"),
        (lambda it: it.__iadd__([1]), WrongType, "the list has a fixed length"),
    ],
)
def test_errors_of_a_list_name_the_place(
    do: Callable[[ValueList], object], error: type[Exception], message: str, store: Store
) -> None:
    with pytest.raises(error) as caught:
        do(store.list)
    assert message in str(caught.value)
    assert store.numbers == [1, 2, 3]


# -- plain values ------------------------------------------------------------------------------------------------------


class Opaque:
    pass


class Broken:
    def __str__(self) -> str:
        raise ValueError


class Text(str):
    __slots__ = ()


@for_each(
    "value, shown",
    [
        (None, None),
        (True, True),
        (1.5, 1.5),
        (np.float64(1.5), 1.5),
        (np.int32(4), 4),
        (Fraction(1, 2), 0.5),
        (Text("x"), "x"),
        ({1: (2, 3), 2: np.float64(1)}, {1: [2, 3], 2: 1.0}),
        ({1: 2, "a": 3}, {"1": 2, "a": 3}),
        ({"b", "a"}, ["a", "b"]),
        (frozenset({2, 1}), [1, 2]),
        (decimal.Decimal("1.5"), "1.5"),
        (Opaque(), "<Opaque>"),
        (Broken(), "<Broken>"),
        (b"ab", "b'ab'"),
    ],
)
def test_plain_values(value: object, shown: object) -> None:
    found = plain(value)
    assert found == shown
    assert type(found) is type(shown)
    json.dumps(found)


# -- what exists -------------------------------------------------------------------------------------------------------


def test_devices_that_exist_are_named() -> None:
    assert "pwm[11]" not in existing_devices()
    before = len(existing_devices())
    spark, relay, hub = wpilib.PWMSparkMax(11), wpilib.Relay(3), wpilib.PneumaticHub(40)
    assert devices_exist()
    found = existing_devices()
    assert [each for each in found if each in ("pwm[11]", "relay[3]")] == ["pwm[11]", "relay[3]"]
    assert "pneumatics or power distribution" in found
    assert len(found) >= before + 3
    del spark, relay, hub


def test_modules_that_the_robot_has_not_made_are_explained() -> None:
    tree = HalData()
    hub = wpilib.PneumaticHub(41)
    assert 41 in tree["ph"]
    assert 40.0 not in tree["ph"]
    assert tree["ph"].get(42) is None
    with pytest.raises(UnknownKey) as caught:
        tree["ph"][42]
    assert str(caught.value).startswith("ph[42]: there is no key 42 in ph\n")
    assert "a module appears when the robot creates it; existing modules: " in str(caught.value)
    assert "41" in str(caught.value)
    assert tree["pcm"][0] is tree["solenoid"]
    with pytest.raises(UnknownKey):
        tree["ph"][0]
    del hub


def test_the_longest_name_of_a_joystick() -> None:
    stick = HalData()["joysticks"][3]
    stick["name"] = "n" * 255
    assert stick["name"] == "n" * 255
    with pytest.raises(WrongValue):
        stick["name"] = "n" * 256
    stick["name"] = ""


def test_which_values_can_be_written() -> None:
    tree = HalData()
    paths = {"pwm[1].value": True, "joysticks[0].axes": True, "time.hasSource": True, "user_program_state": False}
    assert {path: tree.can_write(path) for path in paths} == paths


# -- as text, in comparisons, and as a whole ---------------------------------------------------------------------------


def test_what_a_console_shows(store: Store) -> None:
    tree = HalData()
    assert repr(tree).startswith("<hal_data: ")
    assert ", pwm, " in repr(tree)
    assert repr(store.list) == "<place.list: [1, 2, 3]>"
    assert repr(store.tree) == (
        "<place: {'speed': 0.5, 'count': 2, 'alias': 2, 'const': 7, 'list': [1, 2, 3], 'own': None}>"
    )
    assert repr(LiveDict("", dict)) == "<hal_data: {}>"
    assert (repr(tree["alliance_station"]), str(tree["alliance_station"])) == ("<red1: 1>", "red1")


def test_lists_are_compared_as_pythons_own(store: Store) -> None:
    live, same, more = store.list, [1, 2, 3], [1, 2, 4]
    assert [live == same, live == tuple(same), live == live, live == more, live == "123", live == {1}] == [
        *[True] * 3,
        *[False] * 3,
    ]
    assert [live != same, live != more] == [False, True]
    assert [live < same, live < more, live <= same, live <= [1]] == [False, True, True, False]
    assert [live > same, live > [1], live >= same, live >= more] == [False, True, True, False]
    for compare in ("__lt__", "__le__", "__gt__", "__ge__", "__add__", "__radd__"):
        assert getattr(live, compare)("x") is NotImplemented
    assert (live + more, more + live, live * 2, live.copy()) == (same + more, more + same, same * 2, same)


def test_devices_are_written_as_dicts_by_number_or_name() -> None:
    tree = HalData()
    tree["pwm"][14] = {"raw_value": 1200}
    tree["pwm"][15:17] = [{"raw_value": 1300}, {"raw_value": 1400}]
    assert [tree["pwm"][number]["raw_value"] for number in (14, 15, 16)] == [1200, 1300, 1400]
    hub = wpilib.PneumaticHub(43)
    heard: list[object] = []
    tree["ph"][43][2].register("value", lambda key, value: heard.append(value))
    tree["ph"][43] = [{"value": True}, {}, {"value": True}]
    assert ([each["value"] for each in tree["ph"][43]][:3], heard) == ([True, False, True], [True])
    compressor = tree["ph_compressor"][43]
    for on in (True, False):
        compressor["closed_loop_enabled"] = on
        assert compressor["closed_loop_enabled"] is on
    device = hal.SimDevice("Own [1]")
    speed = device.createDouble("speed", hal.SimDevice.Direction.kBidir, 0.5)
    assert "speed" in tree["CAN"]["Own [1]"]
    assert "angle" not in tree["CAN"]["Own [1]"]
    tree["CAN"]["Own [1]"] = {"speed": 2.5}
    assert speed.get() == 2.5
    del hub, device


def test_each_current_of_a_power_distribution_is_heard_and_added() -> None:
    tree = HalData()
    power = wpilib.PowerDistribution(44, wpilib.PowerDistribution.ModuleType.kRev)
    heard: list[tuple[str, object]] = []
    place = tree["pdp"][44]
    place.register("total_current", lambda key, value: heard.append((key, value)))
    place["current"][3] = 1.5
    place["current"][23] = 2.0
    assert (heard, place["total_current"], power.getCurrent(23)) == (
        [("total_current", 1.5), ("total_current", 3.5)],
        3.5,
        2.0,
    )
    with pytest.raises(WrongValue, match="it is the sum of current: write that"):
        place["total_current"] = 1
    with pytest.raises(WrongIndex, match=r"pdp\[44\].current\[24\]: there is no entry 24, the list has 24"):
        place["current"][24]
    first = wpilib.PowerDistribution(0, wpilib.PowerDistribution.ModuleType.kCTRE)
    assert [number in tree["pdp"] for number in (0, 44, -1, 63)] == [True, True, False, False]
    forget_what_stays()
    assert list(tree["pdp"]) == []
    del first


def test_colours_of_leds_are_three_numbers() -> None:
    data = HalData()["addressable_led"][0]
    data["length"] = 2
    data["data"] = [[1, 2, 3], (255, 0, 0)]
    assert data["data"] == [[1, 2, 3], [255, 0, 0]]
    for wrong in ([[1, 2]], [[1, 2, 256]]):
        with pytest.raises(WrongValue, match=r"expected a list of \[red, green, blue\], each 0 to 255"):
            data["data"] = wrong
