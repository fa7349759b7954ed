"""Motor data at 12 V, from the makers' data sheets.

Most figures are also those of WPILib's `DCMotor` (``wpimath/system/plant/DCMotor.java``), which cites the same sources.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from .units import units

if TYPE_CHECKING:
    from .units import Quantity

#: The voltage at which all figures here were measured.
NOMINAL_VOLTAGE = 12 * units.volt


class MotorModelConfig(NamedTuple):
    """A motor's data, from its data sheet. All but the name are quantities of pint.

    :param name: descriptive name of the motor
    :param nominalVoltage: the voltage of the other figures
    :param freeSpeed: speed without load, 1 / [time], in `units.cpm`, not in pint's `rpm`
    :param freeCurrent: current without load
    :param stallTorque: torque at standstill, [length]**2 * [mass] / [time]**2
    :param stallCurrent: current at standstill
    """

    name: str
    nominalVoltage: Quantity
    freeSpeed: Quantity
    freeCurrent: Quantity
    stallTorque: Quantity
    stallCurrent: Quantity


def _motor(name: str, cpm: float, free_amperes: float, newton_metres: float, stall_amperes: float) -> MotorModelConfig:
    return MotorModelConfig(
        name,
        NOMINAL_VOLTAGE,
        cpm * units.counts_per_minute,
        free_amperes * units.ampere,
        newton_metres * units.N_m,
        stall_amperes * units.ampere,
    )


# The first eight are from the motor curves that VEX measured: https://motors.vex.com

#: Motor configuration for 775 Pro
MOTOR_CFG_775PRO = _motor("775Pro", 18730, 0.7, 0.71, 134)

#: Motor configuration for Andymark RS 775-125
MOTOR_CFG_775_125 = _motor("RS775-125", 5800, 1.6, 0.28, 18)

#: Motor configuration for Andymark 9015
MOTOR_CFG_AM_9015 = _motor("AM-9015", 14270, 3.7, 0.36, 71)

#: Motor configuration for Bag Motor
MOTOR_CFG_BAG = _motor("Bag", 13180, 1.8, 0.43, 53)

#: Motor configuration for Banebots RS 550
MOTOR_CFG_BB_RS550 = _motor("RS550", 19000, 0.4, 0.38, 84)

#: Motor configuration for Banebots RS 775
MOTOR_CFG_BB_RS775 = _motor("RS775", 13050, 2.7, 0.72, 97)

#: Motor configuration for CIM
MOTOR_CFG_CIM = _motor("CIM", 5310, 2.7, 2.42, 133)

#: Motor configuration for Mini CIM
MOTOR_CFG_MINI_CIM = _motor("MiniCIM", 5840, 3.0, 1.41, 89)

#: Motor configuration for REV NEO (REV-21-1650). WPILib's `DCMotor.getNEO`, from REV's data sheet:
#: https://www.revrobotics.com/rev-21-1650/
MOTOR_CFG_NEO = _motor("NEO", 5676, 1.8, 2.6, 105)

#: Motor configuration for REV NEO 550 (REV-21-1651). https://www.revrobotics.com/rev-21-1651/
MOTOR_CFG_NEO_550 = _motor("NEO 550", 11000, 1.4, 0.97, 100)

#: Motor configuration for REV NEO Vortex (REV-21-1652). WPILib's `DCMotor.getNeoVortex`, from REV's data sheet:
#: https://www.revrobotics.com/next-generation-spark-neo/
MOTOR_CFG_NEO_VORTEX = _motor("NEO Vortex", 6784, 3.615, 3.6, 211)

#: Motor configuration for Falcon 500, driven by trapezoidal commutation. https://www.vexrobotics.com/217-6515.html
MOTOR_CFG_FALCON_500 = _motor("Falcon 500", 6380, 1.5, 4.69, 257)

#: Motor configuration for Falcon 500, driven by field-oriented control. WPILib's `DCMotor.getFalcon500Foc`, from
#: https://store.ctr-electronics.com/falcon-500-powered-by-talon-fx/
MOTOR_CFG_FALCON_500_FOC = _motor("Falcon 500 FOC", 6080, 1.5, 5.84, 304)

#: Motor configuration for Kraken X60, driven by trapezoidal commutation. WPILib's `DCMotor.getKrakenX60`, from
#: https://store.ctr-electronics.com/announcing-kraken-x60/
MOTOR_CFG_KRAKEN_X60 = _motor("Kraken X60", 6000, 2, 7.09, 366)

#: Motor configuration for Kraken X60, driven by field-oriented control. WPILib's `DCMotor.getKrakenX60Foc`, from
#: https://store.ctr-electronics.com/announcing-kraken-x60/
MOTOR_CFG_KRAKEN_X60_FOC = _motor("Kraken X60 FOC", 5800, 2, 9.37, 483)

#: Motor configuration for Kraken X44, driven by trapezoidal commutation. WPILib's `DCMotor.getKrakenX44`, from
#: https://motors.ctr-electronics.com/dyno/dynometer-testing/
MOTOR_CFG_KRAKEN_X44 = _motor("Kraken X44", 7758, 2, 4.11, 279)

#: Motor configuration for CTR Electronics Minion. WPILib's `DCMotor.getMinion`, from
#: https://motors.ctr-electronics.com/dyno/dynometer-testing/
MOTOR_CFG_MINION = _motor("Minion", 7704, 2, 3.17, 211)
