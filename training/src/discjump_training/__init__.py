"""Training, baselines and judgement of agents for discjump.

    cli         `discjump train`; commands: `evaluate`, `compare`, `leaderboard`
    recipe      what a training run does, typed; recipes/ holds those that ship
    recipe_file recipes as TOML
    train       PPO from top to bottom: learning, checkpoints, resuming
    export      a policy as ONNX, with its card (`discjump export`)
    runs        the folder of a run
    study       variants of a recipe, several seeds each, and their table
    tune        search for the constants of the scripted baselines
    planner     an upper bound: sequences of actions tried in copies of the environments
    judge       any policy on fixed episodes: scores, failures, pairs, leaderboard, the HTML report
    picture     the picture of an evaluation
    evaluate    a model in the environments that it is judged in
    intervals   bootstrap and exact intervals
    model       model files
    files       written whole or not at all
    baselines   random keys, a scripted skier, one that tacks
    episodes    plays the episodes of a course
    draws       random numbers that belong to an episode
    courses     named terrains and episodes of every task
    policy      what a policy is, observations by name, actions by meaning

Arrows point down only: planner -> cli -> train, tune, judge -> evaluate -> model, baselines -> episodes ->
courses, policy; then `discjump`.
"""
