"""Every check is a function of its own, whose docstring cites the rule.

spaces      what spaces and metadata declare, and whether what comes back is of them
autoreset   what each autoreset mode promises at an episode's end
masks       resets of some environments
seeding     what a seed decides
batch       what a batch's size, order and neighbours must not decide
memory      who may write to which array
lifecycle   refusals and closing

Importing this package fills `registry.CHECKS` in the order of the checks.
"""

# isort: off
from discjump.testing.checks import spaces as spaces
from discjump.testing.checks import memory as memory
from discjump.testing.checks import masks as masks
from discjump.testing.checks import seeding as seeding
from discjump.testing.checks import autoreset as autoreset
from discjump.testing.checks import batch as batch
from discjump.testing.checks import lifecycle as lifecycle
