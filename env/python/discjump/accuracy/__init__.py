"""`discjump accuracy`: how far each fidelity tier strays from `reference`, by situation.

    command     the click command
    report      the Markdown table of a record
    plot        the picture of a record
    measure     plays every tier and compares it with `reference`
    situations  the eight situations: what is played in each
    plays       what every tier is given alike: ground, starts, keys, explosions
    grounds     terrains of the situations
    scripts     keys by tick, decided without looking at the state

Arrows point down only: command -> report, plot, measure -> situations -> plays -> grounds, scripts.
"""
