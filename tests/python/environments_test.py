"""Environments of several agents (parallel_env) and several episodes at a time (vector_env)."""
import unittest

import clearway
import numpy as np
from support import FolderCase, no_action


class ParallelTest(FolderCase):
    """What pettingzoo.test.parallel_api_test asks, without it."""

    def test_follows_the_parallel_api(self) -> None:
        env = clearway.parallel_env("intersection", seeds=[0])
        self.addCleanup(env.close)
        for _ in range(2):
            observations, infos = env.reset()
            self.assertEqual(set(observations), set(env.agents))
            self.assertEqual(set(infos), set(env.agents))
            self.assertEqual(env.agents, env.possible_agents)
            while env.agents:
                live = set(env.agents)
                actions = {}
                for agent in env.agents:
                    self.assertIs(env.observation_space(agent), env.observation_space(agent))
                    self.assertIs(env.action_space(agent), env.action_space(agent))
                    self.assertIn(observations[agent], env.observation_space(agent))
                    actions[agent] = env.action_space(agent).sample(observations[agent]["action_mask"])
                observations, rewards, terminated, truncated, infos = env.step(actions)
                for part in (observations, rewards, terminated, truncated, infos):
                    self.assertEqual(set(part), live)
                self.assertTrue(all(info["illegal_actions"] == 0 for info in infos.values()))
                gone = {agent for agent in live if terminated[agent] or truncated[agent]}
                self.assertEqual(set(env.agents), live - gone)
            self.assertEqual(live, set(env.possible_agents))
        self.assertIn("call reset()", self.message_of(clearway.ClearwayError, lambda: env.step({})))
        env.reset()
        self.assertIn("has no agent 'signal:x'. Did you mean 'signal:center'",
                      self.message_of(clearway.InputError, lambda: env.step({"signal:x": 0})))
        for wrong in (1.7, float("nan"), None, "1", -1, 99):
            self.assertIn("the action of automated:7 is", self.message_of(clearway.InputError, lambda: env.step({"automated:7": wrong})))
        self.assertIn("a dictionary", self.message_of(clearway.InputError, lambda: env.step([0])))


class VectorTest(FolderCase):
    def test_two_at_a_time_are_the_episodes_of_each_alone(self) -> None:
        with clearway.vector_env("intersection", 2, seeds=[3, 4]) as both, clearway.env("intersection", seeds=[4]) as alone:
            observations, _ = both.reset()
            self.assertIn(observations, both.observation_space)
            expected, _ = alone.reset()
            ended = False
            for _ in range(400):
                np.testing.assert_array_equal(observations["vehicles"][1], expected["vehicles"])
                if ended:
                    break
                observations, rewards, terminated, truncated, infos = both.step(np.zeros(both.action_space.shape, dtype=np.int64))
                expected, reward, ended, _, _ = alone.step(no_action(alone))
                self.assertEqual((rewards[1], terminated[1]), (reward, ended))
                self.assertEqual(rewards.shape, (2,))
            self.assertTrue(ended)
            observations, rewards, terminated, _, infos = both.step(np.zeros(both.action_space.shape, dtype=np.int64))
            self.assertEqual((rewards[1], terminated[1]), (0.0, False))  # a new episode has begun
            np.testing.assert_array_equal(observations["vehicles"][1], alone.reset()[0]["vehicles"])

    def test_an_observation_is_the_callers_to_keep_and_change(self) -> None:
        with clearway.vector_env("intersection", 2, seeds=[0, 1], render_mode="ansi") as both:
            nothing = np.zeros(both.action_space.shape, dtype=np.int64)
            kept, _ = both.reset()
            before = {name: array.copy() for name, array in kept.items()}
            observations, _, _, _, infos = both.step(nothing)
            for name, array in observations.items():
                np.testing.assert_array_equal(kept[name], before[name])
                self.assertTrue(array.flags.writeable and array.flags.aligned, name)
            self.assertRegex(both.envs[1].render(), f"{infos['time_s'][1]:.2f} s: EV at")
            np.testing.assert_array_equal(np.concatenate(both.envs[1].action_masks()), observations["action_mask"][1])
            for array in observations.values():
                array[...] = 0
            self.assertGreater(both.step(nothing)[0]["emergency"][1, 0], 0.0)

    def test_the_end_of_a_run_is_told_as_by_each_alone(self) -> None:
        with (clearway.vector_env("intersection", 2, seeds=[0, 1], until="end") as both,
              clearway.env("intersection", seeds=[0], until="end") as alone):
            nothing = np.zeros(both.action_space.shape, dtype=np.int64)
            both.reset()
            alone.reset()
            ended = False
            while not ended:
                observations, rewards, terminated, truncated, infos = both.step(nothing)
                expected, reward, *end, info = alone.step(no_action(alone))
                ended = any(end)
                self.assertEqual([rewards[0], terminated[0], truncated[0]], [reward, *end])
                for name, array in expected.items():
                    np.testing.assert_array_equal(observations[name][0], array)
            self.assertEqual(infos["trace_hash"][0], info["trace_hash"])
            self.assertEqual(infos["_metrics"].tolist(), [True, bool(terminated[1] or truncated[1])])

    def test_wrong_counts_are_told(self) -> None:
        self.assertIn("count is 9", self.message_of(clearway.InputError, lambda: clearway.vector_env("intersection", 9)))
        self.assertIn("count is 0", self.message_of(clearway.InputError, lambda: clearway.vector_env("intersection", 0)))
        self.assertIn("seeds are 4", self.message_of(clearway.InputError, lambda: clearway.vector_env("intersection", 1, seeds=4)))

    def test_a_wrong_action_of_one_leaves_all_where_they_are(self) -> None:
        with clearway.vector_env("intersection", np.int64(2), seeds=[0, 1]) as both:
            nothing = np.zeros(both.action_space.shape, dtype=np.int64)
            wrong = nothing.copy()
            wrong[1, 0] = 99
            times = []
            for actions in (None, wrong):
                both.reset(seed=np.int64(0))
                if actions is not None:
                    self.assertIn("action 0 is 99", self.message_of(clearway.InputError, lambda: both.step(actions)))
                times.append([both.step(nothing)[4]["time_s"].tolist() for _ in range(4)])
            self.assertEqual(times[0], times[1])

    def test_wrong_seeds_are_told(self) -> None:
        with clearway.vector_env("intersection", 1, seeds=[0]) as one:
            for seed, says in ((-1, "seed is -1"), (1.5, "seed is 1.5"), (True, "seed is True"), ([1, 2], "2 seeds for 1"), ("a", "'a'")):
                self.assertIn(says, self.message_of(clearway.InputError, lambda: one.reset(seed=seed)))


if __name__ == "__main__":
    unittest.main()
