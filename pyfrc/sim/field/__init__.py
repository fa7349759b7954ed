"""The simulated field; see `pyfrc.sim.field.user_renderer`."""
