"""`discjump tradeoff`: what speed costs in accuracy, for every tier, tick length and terrain surface.

    command       the click command
    record        measures the sections, writes what came out
    report        the Markdown of a record
    plot          its picture: speed against each error
    pareto        which configurations no other beats in both
    sections      all sections, in the order of the report
    speed         section: player-ticks and agent steps a second
    instructions  section: of a player-tick, counted
    errors        section: how far a path is from the truth after the same keys
    paths         plays situations and compares paths
    outcomes      section: what a scripted skier notices
    skiers        plays episodes and compares them
    apex          section: how high a disc jump goes
    transfer      section: trained in each physics, judged in the task
    training      section: how long a training takes in each physics
    homes         where policies are trained, and their recipes
    section       what a section is, and what it gives to the picture
    store         finished pieces of work on disk: an interrupted run goes on
    grid          configurations, which of them make sense, and how much work is asked for

The truth is `reference` in ticks of 32 ms on triangles: the game's own tick and terrain. Other ticks and
surfaces are other games, and what they cost is told apart from what a tier costs within its own.

Arrows point down only: command -> record -> report, plot, sections -> the sections -> section, store, grid;
then `discjump.accuracy`, `discjump.bench` and the rest of this package.
"""
