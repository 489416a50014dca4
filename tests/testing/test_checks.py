"""Every check has a double that fails it and nothing else, so each failure is named after its cause."""

import pytest
from gymnasium.vector import AutoresetMode
from tests.testing import doubles
from tests.testing.walk import DISABLED, NEXT, SAME, Walk

from discjump.testing import CHECKS, check_vector_env

# Double, the modes in which it breaks its rule, the check that must say so.
BREAKS: list[tuple[type[Walk], tuple[AutoresetMode, ...], str]] = [
    (doubles.OtherActionDtype, (NEXT,), "spaces_are_batched"),
    (doubles.NoMode, (NEXT,), "autoreset_mode_is_declared"),
    (doubles.FourValues, (NEXT,), "rollout_runs"),
    (doubles.RaisesLater, (NEXT,), "rollout_runs"),
    (doubles.NeverAnswers, (NEXT,), "rollout_runs"),
    (doubles.Float64Observation, (NEXT, SAME), "observation_dtype"),
    (doubles.OutOfSpace, (NEXT,), "observation_in_space"),
    (doubles.OutOfSpaceInOneRow, (NEXT,), "observation_in_space"),
    (doubles.RewardColumn, (NEXT,), "reward_array"),
    (doubles.RewardNaN, (NEXT,), "reward_array"),
    (doubles.RewardList, (NEXT,), "reward_array"),
    (doubles.IntegerFlags, (NEXT, SAME), "flag_arrays"),
    (doubles.NoInfoMask, (NEXT, SAME, DISABLED), "info_masks"),
    (doubles.InfoList, (NEXT,), "info_masks"),
    (doubles.ReusesObservation, (NEXT, SAME, DISABLED), "observations_stay"),
    (doubles.ReusesReward, (NEXT,), "rewards_stay"),
    (doubles.ReusesFlags, (NEXT,), "flags_stay"),
    (doubles.ReusesInfo, (NEXT, DISABLED), "infos_stay"),
    (doubles.ReusesFinalObservation, (SAME,), "infos_stay"),
    (doubles.LendsItsState, (NEXT,), "caller_may_write"),
    (doubles.ClipsActions, (NEXT,), "actions_stay"),
    (doubles.IgnoresMask, (NEXT, SAME, DISABLED), "reset_mask_spares_others"),
    (doubles.RefusesMasks, (DISABLED,), "reset_mask_spares_others"),
    (doubles.MaskSeedsAsOne, (NEXT, SAME, DISABLED), "reset_mask_resets"),
    (doubles.MaskInfoOfAll, (NEXT, SAME, DISABLED), "reset_mask_infos"),
    (doubles.TakesAnyMask, (NEXT, SAME, DISABLED), "reset_mask_refusals"),
    (doubles.IgnoresSeeds, (NEXT, SAME, DISABLED), "seed_repeats"),
    (doubles.DrawsGlobally, (NEXT, SAME, DISABLED), "seed_repeats"),
    (doubles.KeepsAge, (NEXT,), "reset_forgets"),
    (doubles.SeedsFromSystem, (NEXT, SAME, DISABLED), "unseeded_reset_continues"),
    (doubles.SeedsGlobally, (NEXT,), "global_generators_do_not_matter"),
    (doubles.DrawsFromRandom, (NEXT,), "global_generators_do_not_matter"),
    (doubles.FirstSeedOnly, (NEXT, DISABLED), "seed_list"),
    (doubles.SpawnsSeeds, (NEXT,), "seed_of_each_environment"),
    (doubles.SpawnsSeedsRefusesLists, (NEXT,), "seed_of_each_environment"),
    (doubles.OneSeedForAll, (NEXT, SAME, DISABLED), "seeds_differ"),
    (doubles.CountsInstances, (NEXT,), "new_instance_repeats"),
    (doubles.PullsNeighbours, (NEXT, SAME, DISABLED), "neighbours_do_not_matter"),
    (doubles.CountsNeighboursInInfo, (NEXT,), "neighbours_leave_infos"),
    (doubles.DependsOnPosition, (NEXT, SAME, DISABLED), "position_does_not_matter"),
    (doubles.DependsOnPositionRefusesLists, (NEXT, SAME, DISABLED), "position_does_not_matter"),
    (doubles.DependsOnBatchSize, (NEXT, SAME, DISABLED), "batch_size_does_not_matter"),
    (doubles.RewardsTheReset, (NEXT,), "next_step_reset_is_empty"),
    (doubles.HeedsActionAtReset, (NEXT,), "next_step_ignores_action"),
    (doubles.NoFinalObservation, (SAME,), "final_obs_masks"),
    (doubles.FinalMaskOfTerminated, (SAME,), "final_obs_masks"),
    (doubles.FinalInfoMaskOfAll, (SAME,), "final_info_masks"),
    (doubles.FinalObservationDtype, (SAME,), "final_obs_in_space"),
    (doubles.FinalObservationIsNext, (SAME,), "final_obs_is_the_last"),
    (doubles.FinalObservationIsStale, (SAME,), "equals_reference"),
    (doubles.GoesOnAfterEnd, (NEXT,), "autoreset_is_a_reset"),
    (doubles.BroadcastsActions, (NEXT,), "wrong_actions_are_refused"),
    (doubles.MovesBeforeItCounts, (NEXT,), "refused_actions_change_nothing"),
    (doubles.ClosesOnce, (NEXT,), "close_twice"),
    (doubles.NeverClosed, (NEXT,), "closed_is_set"),
]

CASES = [(double, mode, name) for double, modes, name in BREAKS for mode in modes]


@pytest.mark.parametrize("mode", AutoresetMode)
@pytest.mark.parametrize("num_envs", [1, 2, 3, 6])
def test_an_environment_that_keeps_the_rules_passes(mode, num_envs):
    report = check_vector_env(lambda n: Walk(n, mode), num_envs=num_envs, strict=True, timeout=20)
    if num_envs > 1:
        assert [outcome.name for outcome in report.skipped] == []


@pytest.mark.parametrize(("double", "mode", "name"), CASES)
def test_a_double_fails_its_check_alone(double, mode, name):
    report = check_vector_env(
        lambda n: double(n, mode),
        strict=True,
        # One that hangs costs its timeout once.
        timeout=0.5 if double is doubles.NeverAnswers else 20,
        reference=(lambda n: Walk(n, mode)) if name == "equals_reference" else None,
        raise_on_failure=False,
    )
    assert [outcome.name for outcome in report.failures] == [name], str(report)


def test_every_check_has_a_double():
    assert {name for _, _, name in BREAKS} == set(CHECKS)
