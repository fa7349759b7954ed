"""A process that has run a robot, put back into the state in which it was before: the next robot runs as in a new one.

In: a process that has imported what every robot needs, and none of the project's modules. Out, after each run: what is
left of the run that could not be put back; nothing if the process is as good as new. Only public calls are used.

Each module is about one kind of thing. It restores what it can, and then says what is left: a device, a thread, an
entry of NetworkTables, a scheduled command, an object of the project's. Nothing is assumed to be clean because it was
restored. What is said is for the user: it is the reason why a new interpreter takes over (`processes.reuse`).

What is not looked at: what C code of a library keeps for itself, and what a library keeps in its own containers of
plain values. Traces of example robots and of matches are compared with those of forked processes in the tests.
"""
