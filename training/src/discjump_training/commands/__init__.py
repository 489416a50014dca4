"""Commands that judge: `discjump evaluate`, `compare` and `leaderboard`.

What takes seconds to import (torch) is imported when it is needed: `--help` should not wait for it.
"""
