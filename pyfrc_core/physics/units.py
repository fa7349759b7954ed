"""The units of the physics helpers: ``5 * units.feet``.

pint is imported on the first use of `units`, not when `units` is imported: code with plain feet never waits for it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    from typing import TypeAlias

    import pint

    from .registry import UnitRegistry

    Quantity: TypeAlias = pint.Quantity[Any]


def _registry() -> UnitRegistry:
    from .registry import registry

    return registry


class _RegistryWhenUsed:
    """A proxy for the registry, also for `isinstance` and pint. It has no attributes of its own."""

    def __getattribute__(self, name: str) -> Any:
        return getattr(_registry(), name)

    def __setattr__(self, name: str, value: object) -> None:
        setattr(_registry(), name, value)

    def __delattr__(self, name: str) -> None:
        delattr(_registry(), name)

    # Python looks these methods up in the class, and not with __getattribute__.
    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        return _registry()(*args, **kwargs)

    def __getitem__(self, item: str) -> Any:
        return _registry()[item]

    def __contains__(self, item: str) -> bool:
        return item in _registry()

    def __iter__(self) -> Iterator[str]:
        return iter(_registry())

    def __dir__(self) -> list[str]:
        return dir(_registry())

    def __repr__(self) -> str:
        return repr(_registry())


#: All units that pyfrc uses: those of pint, and `counts_per_minute` (`cpm`), `N_m`, `tm_kv` and `tm_ka`. This is a unit
#: registry of pint; see https://pint.readthedocs.io. It is not set as the application registry, since there can be only
#: one, and the user may choose it: ``pint.set_application_registry(units)``.
units = cast("UnitRegistry", _RegistryWhenUsed())


class Helpers:
    """Checks of a quantity's dimension.

    Each returns the quantity, and raises pint's `DimensionalityError` for another dimension or a plain number.
    """

    @staticmethod
    def ensure_mass(u: Quantity) -> Quantity:
        return _ensure("[mass]", u)

    @staticmethod
    def ensure_length(u: Quantity) -> Quantity:
        return _ensure("[length]", u)

    @staticmethod
    def ensure_acceleration(u: Quantity) -> Quantity:
        return _ensure("[acceleration]", u)

    @staticmethod
    def ensure_time(u: Quantity) -> Quantity:
        return _ensure("[time]", u)

    @staticmethod
    def ensure_velocity(u: Quantity) -> Quantity:
        return _ensure("[velocity]", u)


def _ensure(dimension: str, u: Quantity) -> Quantity:
    import pint

    quantity: Quantity = units.Quantity(u)
    if not quantity.check(dimension):
        raise pint.DimensionalityError(u, "a quantity of", str(quantity.dimensionality), dimension)
    return u
