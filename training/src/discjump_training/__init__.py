"""Training, baselines and judgement of agents for discjump."""
