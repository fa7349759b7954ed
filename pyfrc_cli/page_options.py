"""Options of the commands that serve a page."""

from __future__ import annotations

import click

port_option = click.option(
    "--port",
    type=click.IntRange(1, 65535),
    metavar="PORT",
    help="Serve the page at this port. Default: any free one.",
)
allow_host_option = click.option(
    "--allow-host",
    multiple=True,
    metavar="HOST",
    help="Also serve the page under this host name, to which a port of this computer is forwarded; may be repeated.",
)
