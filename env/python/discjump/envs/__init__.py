"""Gymnasium environments.

tasks        the tasks by name
named        their environments by name
single       one environment
vector       many, stepped together
task         what both share with the stable-baselines3 adapter: the batch, its spaces, its seeds
options      keyword arguments, checked
callables    observation and reward in Python instead of the task's own; replaced does the work
observations observations with the names of their fields
placement    options of reset
infos        columns of info
render       pictures of running episodes
command_map  the map from above; relief and canvas draw for it
"""
