"""A robot boots without a driver station, an alliance, a match and joysticks: they come with the first packet."""

from __future__ import annotations

import json

import pytest
from conftest import MakeProject, sampled

#: What robot code sees of the driver station.
SEEN = """
    import wpilib

    DS = wpilib.DriverStation


    def seen():
        return (
            DS.getAlliance(), DS.getLocation(), DS.isDSAttached(), DS.isFMSAttached(), DS.isEnabled(),
            DS.getMatchTime(), DS.getGameSpecificMessage(), DS.getEventName(), DS.getMatchNumber(),
            DS.getMatchType().name, DS.isJoystickConnected(0), DS.getStickAxisCount(0),
        )


    NOTHING = (None, None, False, False, False, -1.0, "", "", 0, "kNone", False, 0)
    CONFIGURED = (
        DS.Alliance.kBlue, 2, True, True, True, 42.0, "LRL", "Worlds", 7, "kElimination", True, 12
    )
"""

TIMED = """
    import wpilib
    from seen import seen, CONFIGURED


    class MyRobot(wpilib.TimedRobot):
        moments = {}

        def __init__(self):
            super().__init__()
            wpilib.DriverStation.refreshData()
            self.moments = {"constructed": seen()}

        def robotInit(self):
            wpilib.DriverStation.refreshData()
            self.moments["robotInit"] = seen()

        def robotPeriodic(self):
            self.moments.setdefault("first loop", seen())
"""

OWN_LOOP = """
    import wpilib
    from seen import seen


    class MyRobot(wpilib.RobotBase):
        def __init__(self):
            super().__init__()
            self.moments = {"constructed": seen()}
            self.stopped = False

        def startCompetition(self):
            wpilib.DriverStation.refreshData()
            self.moments["robotInit"] = seen()
            self.moments["waited 0.01 s"] = wpilib.DriverStation.waitForDsConnection(0.01)
            self.moments["waited"] = wpilib.DriverStation.waitForDsConnection(0)
            wpilib.DriverStation.refreshData()
            self.moments["first loop"] = seen()
            while not self.stopped:
                wpilib.wait(0.02)

        def endCompetition(self):
            self.stopped = True
"""

MAGIC = """
    import magicbot
    import wpilib
    from seen import seen


    class MyRobot(magicbot.MagicRobot):
        def createObjects(self):
            self.moments = {"constructed": seen()}
            wpilib.DriverStation.refreshData()
            self.moments["robotInit"] = seen()

        def teleopPeriodic(self):
            self.moments.setdefault("first loop", seen())
"""

TESTS = """
    import hal
    import pytest
    from wpilib.simulation import DriverStationSim as Station

    from seen import CONFIGURED, NOTHING


    def configure(hal_data):
        Station.setAllianceStationId(hal.AllianceStationID.kBlue2)
        Station.setMatchTime(42)
        Station.setEventName("Worlds")
        hal_data["control"]["fmsAttached"] = True
        hal_data["event"]["game_specific_message"] = "LRL"
        hal_data["event"]["match_number"] = 7
        hal_data["event"]["match_type"] = 3


    @pytest.mark.parametrize("run", [1, 2])  # without isolation, the second follows in the same process
    def test_boot(hal_data, control, robot, run):
        configure(hal_data)
        assert hal_data["alliance_station"] == "blue2" and hal_data["event"]["game_specific_message"] == "LRL"
        control.set_operator_control()
        control.run_test(lambda now: now < 0.1)
        moments = robot.moments
        assert moments["constructed"] == moments["robotInit"] == NOTHING
        assert moments["first loop"] == CONFIGURED
        assert moments.get("waited 0.01 s", False) is False and moments.get("waited", True) is True


    def test_red_1_attaches_by_default(hal_data, control, robot):
        assert hal_data["alliance_station"] == "red1" and hal_data["control"]["dsAttached"]
        control.set_operator_control()
        control.run_test(lambda now: now < 0.1)
        alliance, location, attached, *_ = robot.moments["first loop"]
        assert (alliance.name, location, attached) == ("kRed", 1, True)


    def test_an_unknown_alliance_stays_unknown(hal_data, control, robot):
        hal_data["alliance_station"] = "unknown"
        control.set_operator_control()
        control.run_test(lambda now: now < 0.1)
        assert robot.moments["first loop"][:3] == (None, None, True)
        assert hal_data["alliance_station"] == "unknown"
"""


@pytest.mark.parametrize(
    "robot", sampled([TIMED, OWN_LOOP, MAGIC], TIMED, MAGIC), ids=["TimedRobot", "RobotBase", "MagicRobot"]
)
def test_the_first_packet_brings_what_is_configured(robot: str, make_project: MakeProject) -> None:
    project = make_project({"robot.py": robot, "seen.py": SEEN, "tests/test_boot.py": TESTS})
    result = project.run("test", *(["--no-isolation"] if robot is not MAGIC else []))
    assert result.code == 0, result.output


ALLIANCE_IN_ROBOT_INIT = """
    import wpilib

    SIGN = {wpilib.DriverStation.Alliance.kRed: 1, wpilib.DriverStation.Alliance.kBlue: -1}


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.sign = SIGN[wpilib.DriverStation.getAlliance()]
"""


@pytest.mark.slow
def test_code_that_needs_the_alliance_at_boot_fails_everywhere(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ALLIANCE_IN_ROBOT_INIT})
    place = project.place("robot.py", "self.sign = ")
    for command in (["test", "--builtin"], ["sim", "--ui", "none", "--seconds", "1"], ["fuzz", "--runs", "1"]):
        result = project.run(*command)
        assert result.code == 1
        assert " passed" not in result.output, result.output
        assert f"{place}: the alliance is None: it is not known until the driver station is connected" in result.output


def test_a_script_that_writes_an_unknown_alliance_means_it(make_project: MakeProject) -> None:
    robot = """
        import wpilib


        class MyRobot(wpilib.TimedRobot):
            def robotPeriodic(self):
                assert wpilib.DriverStation.isDSAttached()
                if wpilib.DriverStation.getAlliance() is None:
                    wpilib.PWMSparkMax(1)
                    print("no alliance")
                    self.robotPeriodic = lambda: None
    """
    script = [
        {"format": "pyfrc-input 1", "end": 0.5},
        {"t": 0, "set": {"alliance_station": "unknown"}},
        {"t": 0.1, "set": {"mode": "teleop"}},
    ]
    project = make_project({"robot.py": robot})
    (project.path / "script.jsonl").write_text("".join(json.dumps(line) + "\n" for line in script))
    result = project.run("replay", "script.jsonl")
    assert result.code == 0, result.output
    assert "no alliance" in result.output
