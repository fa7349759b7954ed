"""The decorator `pyfrc.invariant`."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

Rule = TypeVar("Rule", bound=Callable[..., object])

#: The attribute of a function that is a rule.
MARK = "__pyfrc_invariant__"


def invariant(rule: Rule) -> Rule:
    """Mark a function in the ``tests`` directory as a rule that always holds while the robot runs.

    ``pyfrc fuzz``, ``pyfrc test`` and ``pyfrc replay`` call it in each packet, after the robot's loop. The rule is
    broken when it raises `AssertionError` or returns False::

        @pyfrc.invariant
        def elevator_is_up_while_the_arm_is_in(robot):
            assert robot.elevator.height >= 0 or not robot.arm.is_in

    :param rule: a function with the parameters ``robot`` (the robot instance), ``hal_data`` (its inputs and outputs),
        both, or none
    :raises TypeError: when the function would never be checked: it is a method, or replaces another rule
    """
    name, path = getattr(rule, "__name__", ""), getattr(rule, "__qualname__", "")
    owner = path.rpartition(".")[0]
    if owner and not owner.endswith("<locals>"):
        raise TypeError(f"the rule {name}() is a method of {owner}: write it as a function, outside of the class")
    if path == name and hasattr(getattr(rule, "__globals__", {}).get(name), MARK):
        raise TypeError(f"there is another rule {name}() above this one, which would never be checked: rename one")
    setattr(rule, MARK, True)
    return rule
