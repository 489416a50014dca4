"""Settings that all tests share."""

from hypothesis import settings

# No test may depend on the speed of the machine; a failing example is printed so that it can be replayed.
settings.register_profile("discjump", deadline=None, print_blob=True)
settings.load_profile("discjump")
