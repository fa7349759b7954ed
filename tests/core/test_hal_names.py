"""Which names `hal_data` has, before anything was read."""

from __future__ import annotations

from loops import for_each

from pyfrc_core.hal import HalData

#: A plain value, a list of devices, one that depends on the robot's modules, and what others keep there.
KINDS = ("time", "pwm", "solenoid", "custom", "reports", "CAN")


@for_each("key", KINDS)
def test_a_name_is_there_before_its_value_was_read(key: str) -> None:
    tree = HalData()
    assert key in tree
    assert key in list(tree)
    tree[key]
    assert key in tree


@for_each("key", ["pwn", "", "PWM", 0, None, ("pwm",)])
def test_what_is_no_name_is_not_there(key: object) -> None:
    assert key not in HalData()


def test_all_that_is_listed_is_there_once() -> None:
    tree = HalData()
    names = list(tree)
    assert all(name in tree for name in names)
    assert len(names) == len(set(names)) == len(tree)
