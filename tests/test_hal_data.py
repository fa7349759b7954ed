"""The tree over real WPILib devices. Channels differ from test to test: the HAL's handles are global."""

from __future__ import annotations

import functools
import json
import os
from collections.abc import Iterator

import hal
import pytest
import wpilib
from hal import simulation as hs
from hypothesis import given
from hypothesis import strategies as st
from loops import for_each
from wpilib import simulation as sim

from pyfrc_core.hal import HalData


@pytest.fixture
def tree() -> Iterator[HalData]:
    hs.resetDriverStationData()
    yield HalData()
    hs.resetDriverStationData()


LISTS = {
    "joysticks": 6, "analog_gyro": 2, "analog_out": 8, "analog_in": 8, "analog_trigger": 8, "pwm": 20,
    "d0_pwm": 26, "relay": 4, "mxp": 16, "dio": 26, "filter": 3, "encoder": 8, "counter": 8, "solenoid": 8,
}  # fmt: skip
FIELDS = {
    "time": "program_start remaining has_source",
    "event": "name match_type match_number replay_number game_specific_message",
    "control": "enabled autonomous test eStop dsAttached fmsAttached has_source",
    "joysticks[0]": "buttons axes povs name has_source",
    "accelerometer": "active range x y z has_source",
    "analog_gyro[0]": "initialized deadband volts_per_degree offset center angle rate",
    "analog_out[7]": "initialized voltage",
    "analog_in[0]": "voltage avg_voltage value avg_value accumulator_value accumulator_count lsb_weight "
    "offset has_source initialized avg_bits oversample_bits accumulator_center accumulator_deadband",
    "analog_trigger[0]": "initialized port trig_lower trig_upper trig_type trig_state",
    "compressor": "initialized closed_loop_enabled on pressure_switch current has_source",
    "pwm[19]": "initialized type raw_value value period_scale zero_latch elim_deadband",
    "d0_pwm[25]": "duty_cycle pin",
    "relay[3]": "initialized fwd rev",
    "mxp[15]": "initialized",
    "dio[25]": "value initialized is_input pulse_length filter_idx has_source",
    "filter[2]": "enabled period",
    "encoder[7]": "count value period direction has_source initialized config max_period reverse_direction "
    "samples_to_average distance_per_pulse rate min_rate",
    "counter[7]": "count direction has_source initialized period mode",
    "solenoid[7]": "initialized value",
    "power": "vin_voltage vin_current "
    + " ".join(f"user_{w}_{r}" for w in ("voltage", "current", "active", "faults") for r in ("6v", "5v", "3v3")),
}


def test_every_documented_list_has_its_length(tree: HalData) -> None:
    assert {key: len(tree[key]) for key in LISTS} == LISTS


@for_each("path", FIELDS)
def test_every_documented_field_is_there_and_can_be_read(tree: HalData, path: str) -> None:
    place = tree.read(path)
    assert not set(FIELDS[path].split()) - set(place)
    assert len(dict(place)) == len(place)


def test_other_documented_keys(tree: HalData) -> None:
    for key in ("robot", "reports", "pcm", "pdp", "CAN", "custom", "ph", "duty_cycle", "addressable_led"):
        assert key in tree
        assert tree[key] is not None
    assert tree["pwm_loop_timing"] == 40
    assert tree["d0_pwm_rate"] is tree["error_data"] is tree["user_program_state"] is None
    assert tree["fpga_button"] is False
    assert tree["event"]["name"] == "sim-event"
    assert (tree["analog_in"][0]["lsb_weight"], tree["analog_in"][0]["offset"]) == (1, 65535)


def test_a_tree_made_after_the_devices_shows_them() -> None:
    output = wpilib.DigitalOutput(20)
    output.set(False)
    dio = HalData()["dio"][20]
    assert (dio["initialized"], dio["is_input"], dio["value"]) == (True, False, False)


def test_encoder_fields(tree: HalData) -> None:
    encoder = wpilib.Encoder(14, 15)
    encoder.setDistancePerPulse(0.5)
    entry = next(e for e in tree["encoder"] if e["initialized"])
    assert entry["distance_per_pulse"] == 0.5
    entry["value"] = 10.0
    assert encoder.getDistance() == entry["distance"] == 5.0
    entry["rate"] = 3
    assert encoder.getRate() == pytest.approx(3)
    with pytest.raises(ValueError, match="config"):
        entry["config"] = {}


def test_channels_that_the_roborio_lacks_are_kept_values(tree: HalData) -> None:
    tree["analog_out"][5]["voltage"] = 2.0
    tree["counter"][0]["count"] = 7
    assert tree["analog_out"][5] == {"initialized": False, "voltage": 2.0}
    assert tree["counter"][0]["count"] == 7
    assert tree["counter"][1]["count"] == 0


@pytest.mark.parametrize("value", ["blue2", "Blue2", 5, hal.AllianceStationID.kBlue2])
def test_alliance_station(tree: HalData, value: object) -> None:
    assert tree["alliance_station"] == "red1"
    tree["alliance_station"] = value
    station = tree["alliance_station"]
    assert station == 5
    assert station == "blue2"
    assert station == hal.AllianceStationID.kBlue2
    assert station != "red1"
    assert json.dumps(station) == "5"
    assert str(station) == "blue2"
    packet()
    assert wpilib.DriverStation.getAlliance() == wpilib.DriverStation.Alliance.kBlue


def packet() -> None:
    hs.notifyDriverStationNewData()
    wpilib.DriverStation.refreshData()


def test_match(tree: HalData) -> None:
    tree["event"] = {"name": "Été", "match_type": "elimination", "match_number": 7, "replay_number": 2}
    tree["event"]["game_specific_message"] = "LRL"
    tree["time"]["remaining"] = 12.5
    tree["control"].update(enabled=True, autonomous=True, fmsAttached=True)
    packet()
    station = wpilib.DriverStation
    assert (station.getEventName(), station.getMatchNumber(), station.getReplayNumber()) == ("Été", 7, 2)
    assert station.getMatchType() == station.MatchType.kElimination
    assert tree["event"]["match_type"] == "elimination"
    assert station.getGameSpecificMessage() == tree["event"]["game_specific_message"] == "LRL"
    assert station.getMatchTime() == 12.5
    assert station.isAutonomousEnabled()
    assert station.isFMSAttached()
    with pytest.raises(ValueError, match="at most 64 bytes"):
        tree["event"]["game_specific_message"] = "x" * 65


@functools.cache
def one_tree() -> HalData:
    return HalData()


@given(st.integers(0, 5), st.integers(0, 11), st.floats(-1, 1, width=32))
def test_a_joystick_axis_reaches_the_robot_with_the_next_packet(stick: int, axis: int, value: float) -> None:
    data = one_tree()
    data["joysticks"][stick]["axes"][axis] = value
    assert data["joysticks"][stick]["axes"][axis] == value
    packet()
    assert wpilib.DriverStation.getStickAxis(stick, axis) == value


def test_joystick_buttons_and_povs(tree: HalData) -> None:
    stick = tree["joysticks"][2]
    assert stick["buttons"] == [False] * 13
    assert stick["povs"] == [-1] * 12
    stick["buttons"][3] = True
    stick["povs"][1] = 90
    assert stick["buttons"][3] is True
    assert stick["povs"][:3] == [-1, 90, -1]
    assert (stick["axis_count"], stick["button_count"], stick["pov_count"]) == (0, 3, 2)
    packet()
    assert wpilib.DriverStation.getStickButton(2, 3)
    assert not wpilib.DriverStation.getStickButton(2, 2)
    assert wpilib.DriverStation.getStickPOV(2, 0) == -1
    assert wpilib.DriverStation.getStickPOV(2, 1) == 90
    stick["button_count"] = 32
    assert len(stick["buttons"]) == 33
    stick["name"] = "Gamepad"
    assert stick["name"] == "Gamepad"
    stick["axes"] = [0.5, -0.5]
    assert stick["axes"][:3] == [0.5, -0.5, 0.0]


def test_joysticks_show_what_wpilib_simulators_set(tree: HalData) -> None:
    pad = sim.XboxControllerSim(3)
    pad.setLeftX(0.25)
    pad.setAButton(True)
    assert tree["joysticks"][3]["axes"][0] == 0.25
    assert tree["joysticks"][3]["buttons"][1] is True
    packet()
    wpilib.XboxController(3).setRumble(wpilib.XboxController.RumbleType.kLeftRumble, 1.0)
    assert tree["joysticks"][3]["left_rumble"] == 65535


@for_each(
    "path, value, error, says",
    [
        ("pwm[0].value", "fast", TypeError, r"pwm\[0\].value: expected a number from -1 to 1, not 'fast'"),
        ("pwm[0].value", 1.5, ValueError, "from -1 to 1"),
        ("pwm[0].value", float("nan"), ValueError, "from -1 to 1"),
        ("pwm[0].value", True, TypeError, "a number"),
        ("encoder[0].count", 2.5, ValueError, "whole number"),
        ("encoder[0].count", 2**31, ValueError, "whole number from"),
        ("encoder[0].count", None, TypeError, "whole number"),
        ("dio[0].value", "off", TypeError, "True or False"),
        ("dio[0].value", 2, ValueError, "True or False"),
        ("joysticks[0].axes[1]", 1.01, ValueError, r"joysticks\[0\].axes\[1\]"),
        ("joysticks[0].axes[-1]", "x", TypeError, r"joysticks\[0\].axes\[11\]"),
        ("joysticks[0].povs[0]", 361, ValueError, "-1 or an angle from 0 to 360"),
        ("joysticks[0].axes", [0.0] * 13, ValueError, "13 values are too many for 12"),
        ("joysticks[0].axes", 1, TypeError, "expected a list"),
        ("alliance_station", "red4", ValueError, "'red3'"),
        ("alliance_station", None, TypeError, "one of"),
        ("event.name", 3, TypeError, "a text"),
        ("user_program_state", "teleop", ValueError, "cannot be written"),
        ("control", 3, TypeError, "expected a dict"),
        ("custom", 3, TypeError, "expected a dict"),
        ("pwm[0].valu", 1, KeyError, "did you mean 'value'.*zero_latch"),
        ("pmw[0].value", 1, KeyError, "did you mean 'pwm'.*There is: CAN"),
        ("pwm[20].value", 1, IndexError, r"pwm\[20\].*the list has 20"),
        ("pwm.value", 1, ValueError, "pwm is a list"),
        ("pwm[0].value.x", 1, ValueError, r"pwm\[0\].value is a float"),
        ("custom.a.b", 1, KeyError, "no 'a' in custom"),
        ("CAN.Motor.Velocity", 1, KeyError, "no key 'Motor' in CAN"),
    ],
)
def test_wrong_writes_say_what_is_wrong(
    tree: HalData, path: str, value: object, error: type[Exception], says: str
) -> None:
    with pytest.raises(error, match=f"(?s){says}"):
        tree.write(path, value)


def test_numbers_of_other_types_are_taken(tree: HalData) -> None:
    numpy = pytest.importorskip("numpy")
    tree["analog_in"][0]["voltage"] = numpy.float32(1.5)
    tree["encoder"][7]["count"] = numpy.int64(3)
    tree["encoder"][7]["direction"] = numpy.bool_(True)
    tree["analog_gyro"][0]["angle"] = float("nan")
    assert (tree["analog_in"][0]["voltage"], tree["encoder"][7]["count"]) == (1.5, 3)
    tree["analog_in"][0]["voltage"] = tree["encoder"][7]["count"] = tree["analog_gyro"][0]["angle"] = 0


def test_listeners_hear_each_set_once(tree: HalData) -> None:
    heard: list[tuple[str, object]] = []

    def hear(key: str, value: object) -> None:
        heard.append((key, value))

    motor, pwm = wpilib.PWMSparkMax(11), tree["pwm"][11]
    pwm.register("value", hear, notify=True)
    motor.set(0.5)
    pwm["value"] = 0.25
    pwm["value"] = 0.25
    assert heard == [("value", 0.0), ("value", 0.5), ("value", 0.25), ("value", 0.25)]
    heard.clear()
    encoder = tree["encoder"][6]
    encoder.register("value", hear)
    encoder.register("count", hear)
    encoder["count"] = 4
    assert heard == [("value", 4), ("count", 4)]
    heard.clear()
    tree["control"].register("enabled", hear)
    hs.setDriverStationEnabled(True)
    tree.register("error_data", hear)
    tree["error_data"] = "teleop"
    tree["joysticks"][0].register("axes", hear)
    tree["joysticks"][0]["axes"][1] = 0.5
    assert [key for key, _ in heard] == ["enabled", "error_data", "axes"]
    with pytest.raises(KeyError):
        pwm.register("speed", hear)


def test_what_a_listener_raises_reaches_the_one_who_set(tree: HalData) -> None:
    def refuse(_key: str, _value: object) -> None:
        raise RuntimeError("no")

    tree["pwm"][12].register("value", refuse)
    with pytest.raises(RuntimeError, match="no"):
        tree["pwm"][12]["value"] = 0.5


def test_snapshot_is_plain(tree: HalData) -> None:
    tree["custom"].update({"a": (1, {2}), "b": object(), "c": float("nan")})
    copy = tree.snapshot()
    assert type(copy["alliance_station"]) is int
    assert copy["custom"]["a"] == [1, [2]]
    assert copy["custom"]["b"] == "<object>"
    assert set(copy) == set(tree)
    assert json.loads(json.dumps(copy, allow_nan=True))["pwm"][3]["value"] == 0.0


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")  # WPILib's threads do not matter to the child
def test_a_fork_has_a_tree_of_its_own(tree: HalData) -> None:
    list(tree.leaves())
    child = os.fork()
    if child == 0:
        tree["custom"]["x"] = 1
        os._exit(0 if dict(tree.leaves())["custom.x"] == 1 else 1)
    assert os.waitpid(child, 0)[1] == 0
    assert "custom.x" not in dict(tree.leaves())
