"""`python -m discjump_training.robustness`."""

from discjump_training.robustness.command import main

main()
