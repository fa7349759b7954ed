"""The collector of circular references is paused during imports."""

from __future__ import annotations

import gc

from pyfrc_core.collector import collector_paused


def test_it_is_paused_and_then_as_before() -> None:
    assert gc.isenabled()
    kept = []
    try:
        with collector_paused():
            assert not gc.isenabled()
            kept.append({})
        assert gc.isenabled()
        assert not any(each is kept for each in gc.get_objects()), "it does not look at them again"
        gc.disable()
        with collector_paused():
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()
        gc.unfreeze()
