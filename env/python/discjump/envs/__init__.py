"""Gymnasium environments.

ski          one environment
vector       many, stepped together
task         what both share with the stable-baselines3 adapter: the batch, its spaces, its seeds
options      keyword arguments, checked
placement    options of reset
infos        columns of info
render       pictures of running episodes
command_map  the map from above; relief and canvas draw for it
"""
