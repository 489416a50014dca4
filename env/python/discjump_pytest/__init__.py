"""The pytest plugin of discjump: conformance of vector environments as test items, and fixtures.

    pytest --discjump-verify                              one item for each check of each declared environment
    pytest --discjump-verify -m discjump                  these items alone
    pytest --discjump-verify --discjump-env CartPole-v1   one more environment

Environments are declared in the ini file (`discjump_envs`) or by the hook `pytest_discjump_envs` in
conftest.py; `discjump.testing.declared` has the grammar. A package of its own, because pytest loads plugins
at every start: it imports nothing of discjump, numpy or gymnasium until an option or a fixture asks for it.
"""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from discjump.testing import Report

    Environments = Mapping[str, Callable[[int], Any]]

MARKER = "discjump: checks of vector environments, made by `--discjump-verify`"


class Hooks:
    """Hooks of this plugin, for conftest.py and other plugins."""

    @pytest.hookspec
    def pytest_discjump_envs(self, config: pytest.Config) -> "Environments":
        """Environments to verify: factories, which make a vector environment of n environments, by name."""
        raise NotImplementedError


def pytest_addoption(parser: pytest.Parser) -> None:
    """Options and ini settings."""
    group = parser.getgroup("discjump", "discjump: conformance and determinism of vector environments")
    group.addoption(
        "--discjump-verify",
        action="store_true",
        help="check every declared vector environment, one test item for each check",
    )
    group.addoption(
        "--discjump-env",
        action="append",
        default=[],
        metavar="ENV",
        help="one more environment: a gymnasium id or module:factory, with key=value words; may be repeated",
    )
    group.addoption(
        "--discjump-strict", action="store_true", help="also the checks that gymnasium's own fail"
    )
    parser.addini("discjump_envs", "vector environments to check, one in each line", type="linelist")
    parser.addini("discjump_skip", "names of checks that are left out", type="args")
    parser.addini("discjump_ignore_info", "keys of info that need not repeat, dotted", type="args")
    parser.addini("discjump_strict", "whether to make the strict checks as well", type="bool", default=False)
    parser.addini("discjump_num_envs", "environments of a batch (default: 3)")
    parser.addini("discjump_steps", "most steps of a rollout (default: 1000)")
    parser.addini("discjump_seed", "seed of the rollouts (default: 0)")
    parser.addini("discjump_timeout", "seconds for each check (default: 60)")


def pytest_addhooks(pluginmanager: pytest.PytestPluginManager) -> None:
    """Make `pytest_discjump_envs` known."""
    pluginmanager.add_hookspecs(Hooks)


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker, and what collects the items if they are asked for."""
    config.addinivalue_line("markers", MARKER)
    if config.getoption("--discjump-verify"):
        from discjump.testing import plugin

        config.pluginmanager.register(plugin.Verification(), "discjump-verify")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run a test that uses `discjump_env_factory` once for each declared environment."""
    if "discjump_env_name" in metafunc.fixturenames:
        from discjump.testing import declared

        metafunc.parametrize("discjump_env_name", list(declared.of(metafunc.config)), indirect=True)


@pytest.fixture
def discjump_env_name(request: pytest.FixtureRequest) -> str:
    """The name of a declared environment."""
    return str(request.param)


@pytest.fixture
def discjump_env_factory(discjump_env_name: str, pytestconfig: pytest.Config) -> Callable[[int], Any]:
    """What makes a declared environment, `factory(num_envs)`; a project may define this fixture itself
    instead."""
    from discjump.testing import declared

    return declared.of(pytestconfig)[discjump_env_name].factory()


@pytest.fixture
def discjump_check(pytestconfig: pytest.Config) -> "Callable[..., Report]":
    """`discjump.testing.check_vector_env` with the settings of the ini file; keyword arguments win over
    them."""
    from discjump.testing import check_vector_env, declared

    settings = declared.settings(pytestconfig)

    def check(env: Any, **options: Any) -> "Report":
        return check_vector_env(env, **{**settings, **options})

    return check
