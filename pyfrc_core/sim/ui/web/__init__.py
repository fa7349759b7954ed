"""The simulator in a browser: `front_end` serves a page, and `page_file` writes one that needs no server.

In: a `Source`, such as a `Simulation` or a log, and messages of pages. Out: JSON over one WebSocket for each page.
starlette and uvicorn are dependencies of pyfrc itself: the front end that needs no display must not be the one that has
to be installed first.

- `collector` reads the source by its cursors, on a thread of its own, and keeps what all pages show. `updates`
  sends to each page what has changed since its last message, once the page has taken that: there is no queue.
- `runs` keeps the changes of all runs in memory, so that looking at the past asks neither the robot nor a replay.
- `commands` is one table of what a page may ask for. It is carried out on one thread, in the order of arrival.
- `page` is HTML, CSS and ES modules without a build step: a team changes a file and reloads. An import map has the
  modules' places. Libraries and fonts are unchanged files of their npm packages (`page/vendor`). Texts of the robot
  become text nodes, never HTML. ``make check-page`` checks types and style, and runs the unit tests in `tests/page`.
- `access`: the token in the address is the only key. A cookie would go to every server on this computer, since cookies
  do not know ports. Over the network, the token that drives works only with ``--share drive``.
- `recorded_page`: the same page with the run in it, for a browser without pyfrc.
"""
