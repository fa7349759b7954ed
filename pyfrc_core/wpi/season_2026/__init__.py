"""WPILib 2026: a module for each topic. The package of another season has the same modules, with the same functions.

- A run: `timing` (HAL time), `station` (modes, packets, match, the loss of the connection), `robots` (their kinds, and
  each step of their lives), `watchdogs` (WPILib's own threads), `reports` (what it prints).
- What robot code is made of: `names` (of methods), `callbacks` (what libraries call), `commands`, `joysticks`,
  `motor_controllers`, `network_reads`, `source` (what pyfrc writes of it).
- What it works with: `devices`, `sim_devices`, `encoders`, `motors`, `geometry`, `fields`, `dashboards`, `network`,
  `logs`.

Constants and types are part of a topic as functions are: `station.MODES`, `geometry.Pose2d`.
"""
