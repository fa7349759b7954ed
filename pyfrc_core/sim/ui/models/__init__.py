"""What every front end shows and binds, without any toolkit.

In: the values of a snapshot, keys. Out: rows of devices, controls of time, outlines on the field, texts. A
new device gets its rows in `devices`; only a new kind of row needs a class in each toolkit.
"""
