"""`discjump bench`: how fast each way in is, and beside what.

    command       the click command
    figures       every figure that is asked for
    ppo           the environment's share of a training run
    scenes        what a scene models, stores and costs
    peers         what others offer, in the same run
    parts         where the time of a step goes, and its picture
    figure        what a figure is, and its line in the table
    ways          the ways in: simulator, Rust, gymnasium, stable-baselines3
    instructions  cases counted by callgrind, which runs `counted`
    clock         cases take turns within a repeat; medians and quartiles

Arrows point down only.
"""
