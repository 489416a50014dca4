"""Training, baselines and judgement of agents for discjump.

    cli         `discjump train`; commands: `evaluate`, `compare`, `leaderboard`; export_command
    recipe      what a training run does, typed; recipes/ holds those that ship
    recipe_file recipes as TOML
    train       PPO from top to bottom: learning, checkpoints, resuming
    joint       a policy that chooses all keys at once
    export      a policy as ONNX, card says what it is (`discjump export`)
    shipped     the policies that come with the package, as they were exported
    runs        the folder of a run
    study       variants of a recipe, several seeds each, and their table
    tune        search for the constants of the scripted baselines
    planner     what is possible: sequences of actions tried in copies of the environments
    bounds      what disc jumps reach: searches over when to walk, jump, shoot and burn
    robustness  the same policies on other grounds, with other armors, noise and tiers
    tradeoff    speed against accuracy (`discjump tradeoff`)
    scores      the results of all tasks in one table
    judge       any policy on fixed episodes: scores, failures, pairs, leaderboard, the HTML report
    picture     the picture of an evaluation; curves draws learning curves
    evaluate    a model in the environments that it is judged in
    intervals   bootstrap and exact intervals; markdown has tables and cells of them
    model       model files
    files       written whole or not at all
    baselines   random keys, scripted skiers, a disc jumper, a route runner
    episodes    plays the episodes of a course
    draws       random numbers that belong to an episode
    courses     named terrains and episodes of every task
    policy      what a policy is, observations by name, actions by meaning

Arrows point down only: planner, bounds -> cli -> train, tune, judge -> evaluate -> model, baselines ->
episodes -> courses, policy; then `discjump`.
"""
