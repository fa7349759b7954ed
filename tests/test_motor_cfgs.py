"""The motors: the figures of their data sheets, against WPILib's own table of them."""

from __future__ import annotations

import math

import pytest
from loops import for_each
from wpimath.system.plant import DCMotor

from pyfrc.physics import motor_cfgs
from pyfrc.physics.motor_cfgs import MotorModelConfig
from pyfrc.physics.tankmodel import TankModel
from pyfrc.physics.units import units

#: The name of each motor, and WPILib's function for it.
MOTORS = {
    "MOTOR_CFG_775PRO": ("775Pro", DCMotor.vex775Pro),
    "MOTOR_CFG_775_125": ("RS775-125", DCMotor.RS775_125),
    "MOTOR_CFG_AM_9015": ("AM-9015", DCMotor.andymark9015),
    "MOTOR_CFG_BAG": ("Bag", DCMotor.bag),
    "MOTOR_CFG_BB_RS550": ("RS550", DCMotor.banebotsRS550),
    "MOTOR_CFG_BB_RS775": ("RS775", DCMotor.banebotsRS775),
    "MOTOR_CFG_CIM": ("CIM", DCMotor.CIM),
    "MOTOR_CFG_MINI_CIM": ("MiniCIM", DCMotor.miniCIM),
    "MOTOR_CFG_NEO": ("NEO", DCMotor.NEO),
    "MOTOR_CFG_NEO_550": ("NEO 550", DCMotor.NEO550),
    "MOTOR_CFG_NEO_VORTEX": ("NEO Vortex", DCMotor.neoVortex),
    "MOTOR_CFG_FALCON_500": ("Falcon 500", DCMotor.falcon500),
    "MOTOR_CFG_FALCON_500_FOC": ("Falcon 500 FOC", DCMotor.falcon500FOC),
    "MOTOR_CFG_KRAKEN_X60": ("Kraken X60", DCMotor.krakenX60),
    "MOTOR_CFG_KRAKEN_X60_FOC": ("Kraken X60 FOC", DCMotor.krakenX60FOC),
    "MOTOR_CFG_KRAKEN_X44": ("Kraken X44", DCMotor.krakenX44),
    "MOTOR_CFG_MINION": ("Minion", DCMotor.minion),
}


def test_every_motor_is_compared() -> None:
    assert {name for name in dir(motor_cfgs) if name.startswith("MOTOR_CFG_")} == set(MOTORS)
    assert set(MOTORS) < set(motor_cfgs.__all__)


@for_each("constant", MOTORS)
def test_figures_are_those_of_wpilib(constant: str) -> None:
    name, dc_motor = MOTORS[constant]
    ours: MotorModelConfig = getattr(motor_cfgs, constant)
    theirs = dc_motor(1)
    assert ours.name == name
    assert ours.nominalVoltage.to("volt").magnitude == theirs.nominalVoltage
    # WPILib's is in radians per second; counts have no angle in them.
    assert ours.freeSpeed.to("1 / second").magnitude * math.tau == pytest.approx(theirs.freeSpeed)
    assert ours.freeCurrent.to("ampere").magnitude == pytest.approx(theirs.freeCurrent)
    assert ours.stallTorque.to("newton * metre").magnitude == pytest.approx(theirs.stallTorque)
    assert ours.stallCurrent.to("ampere").magnitude == pytest.approx(theirs.stallCurrent)


def test_a_motor_of_ones_own() -> None:
    own = MotorModelConfig(
        "CIM in other units", 12000 * units.mV, 88.5 * units.Hz, 2.7 * units.A, 242 * units.N * units.cm, 133 * units.A
    )
    assert own._replace(name="CIM").name == "CIM"
    assert own.nominalVoltage == motor_cfgs.NOMINAL_VOLTAGE
    ours, cim = (TankModel.theory(motor, 90 * units.lbs, 10.71) for motor in (own, motor_cfgs.MOTOR_CFG_CIM))
    assert ours.get_distance(-1, 0.5, 0.5) == pytest.approx(cim.get_distance(-1, 0.5, 0.5))
