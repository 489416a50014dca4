"""What plays a recording, given as plain data: a header of JSON's types, and arrays by name.

    codec   plain data as bytes, with nothing in them that runs
    build   terrains, environments and simulators from plain data
    play    frames of a recording, tick by tick
    worker  the same over a pipe

These modules import nothing of discjump but its public names, and each other relatively: a worker runs them
inside another installation, of another release, which need not have them.
"""
