"""`discjump stress`: whether the simulator stands its extremes, in every tier, precision and surface.

    command     the click command
    report      the Markdown of a record
    picture     the picture of a record
    replay      plays one player of one case again, and shows the tick
    long        the long form, part by part
    endurance   ten million ticks without pause
    episodes    a million episodes of `discjump/Ski-v0`
    matrix      plays extremes in columns, and says of each cell how it went
    expected    failures that are expected, with reason and limit
    refusals    numbers that are none
    repeats     the same bits again
    blasts      explosions against their closed form
    checks      what must hold of every tick
    energy      how much energy a tick may add
    play        plays a case in a column, and keeps every state
    own         the extremes of a ground that is not ours
    extremes    the rows of the matrix on the suite's own grounds
    starts      starts and keys, drawn from fixed seeds
    grounds     terrains of the extremes
    floor       the ground as users ask for it, at any distance
    cases       what is played: columns, cases, starts
    rules       what a tick does to a velocity before the move

Arrows point down only: command -> replay, long, report, picture -> matrix -> expected, refusals, repeats,
blasts -> checks -> energy, play; own -> extremes -> starts, grounds -> floor -> cases -> rules.
"""
