"""The variables by which `pyfrc sim` decides whether it opens a browser."""

#: As on a machine without a screen, with a person at it.
NO_BROWSER = dict.fromkeys(("DISPLAY", "WAYLAND_DISPLAY", "BROWSER", "CI", "SSH_CONNECTION", "SSH_TTY"), "")
