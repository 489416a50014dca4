"""`discjump theory`: the simulator against closed forms, where the model has any.

    command      the click command
    report       the Markdown tables of a record
    plot         the picture of a record
    convergence  errors against the continuous motion by length of the tick, and their order
    figures      single figures (apex, burn, stopping distance ...) against their closed forms
    blasts       push of an explosion by distance
    hops         period and acceleration of skiing on planes
    bumps        speed lost on smooth slopes that are cut into triangles
    forms        the closed forms, in plain Python; nothing of the simulator
    lab          tiers, grounds, starts, and runs of a simulator

Arrows point down only: command -> report, plot, convergence, figures, blasts, hops, bumps -> forms, lab.
"""
