"""How far policies carry: the same ones under conditions that they were not trained in.

    python -m discjump_training.robustness ppo=runs/ski-0,runs/ski-1 --task ski --out results/robustness

conditions  what is changed: ground, armor, noise, tier
table       who does how well under each of them
"""
