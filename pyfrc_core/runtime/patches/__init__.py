"""The names that are replaced before the robot's modules are imported; here they are spelled as WPILib spells them.

In: a call by robot code, or by a test. Out: what a robot would do, in robot time, for the run of this process
(`active_run`); what the original does where no robot runs. `install` has the whole table.
"""
