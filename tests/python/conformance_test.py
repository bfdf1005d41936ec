"""What gymnasium's check_env, pettingzoo's parallel_api_test and its parallel_seed_test assert, asserted here of classes that derive
from theirs.

Where the two packages are installed, their own checks run, too; stand_ins/ holds as much of them as deriving takes where they are not.
"""
import copy
import inspect
import random
import sys
import unittest
import unittest.mock
import warnings
from pathlib import Path

sys.path.append(str(Path(__file__).parent / "stand_ins"))  # behind what is installed, so that the originals win

import clearway  # noqa: E402
import gymnasium  # noqa: E402
import numpy as np  # noqa: E402
import pettingzoo  # noqa: E402
from support import FolderCase  # noqa: E402

spaces = gymnasium.spaces


def is_stand_in(package) -> bool:  # noqa: ANN001
    return getattr(package, "STAND_IN", False)


class StandInTest(unittest.TestCase):
    def test_the_environments_derive_from_their_classes(self) -> None:
        self.assertTrue(issubclass(clearway.Env, gymnasium.Env))
        self.assertTrue(issubclass(clearway.VectorEnv, gymnasium.vector.VectorEnv))
        self.assertTrue(issubclass(clearway.ParallelEnv, pettingzoo.ParallelEnv))


class ConformanceCase(FolderCase):
    """Their ``data_equivalence``, exact, and warnings as failures: the checkers warn where they do not assert."""

    def setUp(self) -> None:
        super().setUp()
        caught = warnings.catch_warnings()
        caught.__enter__()
        self.addCleanup(caught.__exit__, None, None, None)
        warnings.simplefilter("error")

    def check_equal(self, left: object, right: object) -> None:
        self.assertIs(type(left), type(right))
        if isinstance(left, dict):
            self.assertEqual(left.keys(), right.keys())
            for name in left:
                self.check_equal(left[name], right[name])
        elif isinstance(left, (tuple, list)):
            self.assertEqual(len(left), len(right))
            for one, other in zip(left, right):
                self.check_equal(one, other)
        elif isinstance(left, np.ndarray):
            self.assertEqual((left.dtype, left.shape), (right.dtype, right.shape))
            np.testing.assert_array_equal(left, right)
        else:
            self.assertEqual(left, right)

    def check_resets_follow_the_last_seed(self, env, action: object) -> None:  # noqa: ANN001
        """Whatever an environment has done, a seed decides what the resets after it begin, with and without options."""
        for seed in (123, 1):
            first, second = env.reset(seed=seed), env.reset()
            env.reset()
            env.step(action)
            for options in (None, {"options": 1}):
                self.check_equal(env.reset(seed=seed, options=options), first)
                self.check_equal(env.reset(options=options), second)


class GymnasiumTest(ConformanceCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.env = clearway.env("intersection", seeds=range(3), render_mode="ansi")
        cls.addClassCleanup(cls.env.close)

    def check_space(self, space) -> None:  # noqa: ANN001
        self.assertIsInstance(space, spaces.Space)
        if isinstance(space, spaces.Dict):
            self.assertGreater(len(space.spaces), 0)
            for below in space.values():
                self.check_space(below)
        elif isinstance(space, spaces.MultiDiscrete):
            self.assertEqual(space.shape, space.nvec.shape)
            self.assertTrue((space.nvec > 0).all())
        else:
            self.assertIsInstance(space, spaces.Box)
            self.assertEqual((space.low.shape, space.high.shape), (space.shape, space.shape))
            self.assertTrue((space.low < space.high).all())
            self.assertTrue(np.isfinite(space.low).all() and np.isfinite(space.high).all())

    def check_observation(self, observation: object) -> None:
        space = self.env.observation_space
        self.assertIs(type(observation), dict)
        self.assertEqual(observation.keys(), space.spaces.keys())
        for name, array in observation.items():
            self.assertIs(type(array), np.ndarray, name)
            self.assertEqual((array.dtype, array.shape), (space[name].dtype, space[name].shape), name)
            self.assertTrue(array.flags.writeable and array.flags.aligned and array.flags.c_contiguous, name)
        self.assertIn(observation, space)

    def test_class_and_spaces(self) -> None:
        env = self.env
        self.assertIsInstance(env, gymnasium.Env)
        self.assertIs(env.unwrapped, env)
        self.assertFalse(env.metadata.get("jax", False) or env.metadata.get("torch", False))
        self.check_space(env.action_space)
        self.check_space(env.observation_space)
        self.assertIn(env.action_space.sample(), env.action_space)
        self.assertIn(env.observation_space.sample(), env.observation_space)

    def test_its_spec_makes_another_one_like_it(self) -> None:
        self.assertEqual(self.env.spec.id, "clearway/Emergency-v0")
        self.assertIsNone(self.env.spec.max_episode_steps)
        with self.env.spec.make(render_mode=None) as other:
            self.assertIsInstance(other.unwrapped, clearway.Env)
            self.assertIsNone(other.render_mode)
            self.assertIn(self.env.reset(seed=1)[0], other.observation_space)
            self.check_equal(other.reset(seed=0)[0], self.env.reset(seed=0)[0])
        with clearway.env("intersection", seeds=[0], variant="dense") as dense, dense.spec.make() as other:
            self.check_equal(other.reset()[0], dense.reset()[0])

    def test_gymnasium_makes_one_by_name(self) -> None:
        if is_stand_in(gymnasium):
            self.skipTest("gymnasium is not installed (it is in no Debian package)")
        with gymnasium.make("Clearway/intersection-v0", seeds=[0]) as made:
            self.assertIsInstance(made.unwrapped, clearway.Env)
            self.check_equal(made.reset(seed=0)[0], self.env.reset(seed=0)[0])

    def test_signature_of_reset(self) -> None:
        parameters = inspect.signature(self.env.reset).parameters
        self.assertEqual(list(parameters), ["seed", "options"])
        for one in parameters.values():
            self.assertIs(one.kind, inspect.Parameter.KEYWORD_ONLY)
            self.assertIsNone(one.default)
        self.assertFalse(callable(getattr(self.env, "seed", None)))

    def test_reset_returns_observation_and_info_and_takes_options(self) -> None:
        for result in (self.env.reset(), self.env.reset(options={}), self.env.reset(options={"options": 1})):
            self.assertIs(type(result), tuple)
            observation, info = result
            self.check_observation(observation)
            self.assertIs(type(info), dict)

    def test_reset_follows_its_seed(self) -> None:
        env = self.env
        first, _ = env.reset(seed=123)
        self.check_observation(first)
        generator = copy.deepcopy(env.unwrapped._np_random)
        self.assertIsInstance(env.np_random, np.random.Generator)
        self.assertEqual(env.np_random_seed, 123)
        again, _ = env.reset(seed=123)
        self.check_equal(first, again)
        self.assertEqual(env.unwrapped._np_random.bit_generator.state, generator.bit_generator.state)
        other, _ = env.reset(seed=456)
        self.check_observation(other)
        self.assertNotEqual(env.unwrapped._np_random.bit_generator.state, generator.bit_generator.state)
        env.reset()  # without a seed the generator stays
        env.reset(seed=456)
        state = copy.deepcopy(env.np_random.bit_generator.state)
        env.reset()
        self.assertEqual(env.np_random.bit_generator.state, state)

    def test_the_next_replication_follows_from_the_seed_alone(self) -> None:
        self.check_resets_follow_the_last_seed(self.env, self.env.action_space.sample())
        with self.env.spec.make() as other:  # which has another past
            self.env.reset(seed=123)
            other.reset()
            other.reset(seed=123)
            self.check_equal(other.reset(), self.env.reset())

    def test_a_step_is_deterministic_and_has_the_right_types(self) -> None:
        env = self.env
        env.action_space.seed(123)
        action = env.action_space.sample()
        results, states = [], []
        for _ in range(2):
            env.reset(seed=123)
            results.append(env.step(action))
            states.append(copy.deepcopy(env.unwrapped._np_random.bit_generator.state))
        for observation, reward, terminated, truncated, info in results:
            self.check_observation(observation)
            self.assertTrue(np.issubdtype(type(reward), np.floating) and np.isfinite(reward))
            self.assertEqual((type(terminated), truncated, type(info)), (bool, False, dict))
        for left, right in zip(*results):
            self.check_equal(left, right)
        self.assertEqual(states[0], states[1])

    def test_an_observation_is_the_callers_to_keep(self) -> None:
        kept, _ = self.env.reset(seed=0)
        before = copy.deepcopy(kept)
        for array in self.env.step(np.zeros(self.env.action_space.shape, dtype=np.int64))[0].values():
            array[...] = 0  # and may be changed
        self.check_equal(kept, before)
        self.assertGreater(self.env.step(np.zeros(self.env.action_space.shape, dtype=np.int64))[0]["emergency"][0], 0.0)

    def test_actions_are_sampled_under_the_mask(self) -> None:
        self.env.reset(seed=0)
        for _ in range(20):
            action = self.env.action_space.sample(self.env.action_masks())
            self.assertIn(action, self.env.action_space)
            self.assertEqual(self.env.step(action)[4]["illegal_actions"], 0)

    def test_every_mode_renders(self) -> None:
        modes = self.env.metadata["render_modes"]
        self.assertIs(type(modes), list)
        self.assertIn(self.env.render_mode, modes)
        self.assertGreater(self.env.metadata["render_fps"], 0)
        for mode in modes:
            with self.env.spec.make(render_mode=mode) as other:
                self.assertEqual(other.render_mode, mode)
                other.reset()
                self.assertIs(type(other.render()), {"ansi": str}[mode])

    def test_a_road_without_signals_conforms(self) -> None:
        with clearway.env("merge", seeds=[0]) as env, unittest.mock.patch.object(self, "env", env):
            self.assertEqual(env.signal_ids, [])
            self.test_class_and_spaces()
            self.test_reset_returns_observation_and_info_and_takes_options()
            self.test_a_step_is_deterministic_and_has_the_right_types()

    def test_every_observation_of_an_episode_is_in_the_space(self) -> None:
        with clearway.env("intersection", seeds=[2], failure="mixed", predictor="dead_reckoning", until="end") as faulty:
            observation, _ = faulty.reset()
            done, steps = False, 0
            while not done:
                self.check_observation(observation)
                observation, reward, terminated, truncated, info = faulty.step(faulty.action_space.sample(faulty.action_masks()))
                self.assertTrue(np.isfinite(reward))
                done, steps = terminated or truncated, steps + 1
            self.check_observation(observation)
            self.assertGreater(steps, 20)

    def test_close_may_be_repeated(self) -> None:
        env = self.env.spec.make(render_mode=None)  # closed before its first reset
        self.assertIsNone(env.render())
        env.close()
        env.close()

    def test_their_own_check(self) -> None:
        if is_stand_in(gymnasium):
            self.skipTest("gymnasium is not installed (it is in no Debian package)")
        from gymnasium.utils.env_checker import check_env
        check_env(self.env, skip_render_check=False)


class VectorTest(ConformanceCase):
    def test_class_and_spaces(self) -> None:
        with clearway.vector_env("intersection", 2, seeds=range(4)) as envs:
            self.assertIsInstance(envs, gymnasium.vector.VectorEnv)
            self.assertEqual((envs.num_envs, envs.closed), (2, False))
            modes = getattr(gymnasium.vector, "AutoresetMode", None)
            self.assertEqual(envs.metadata["autoreset_mode"], modes.NEXT_STEP if modes else "NextStep")
            observations, infos = envs.reset(seed=5)
            self.assertIn(observations, envs.observation_space)
            self.assertEqual(infos["seed"].tolist(), [5, 6])
            result = envs.step(envs.action_space.sample())
            self.assertIn(result[0], envs.observation_space)
            self.assertEqual([part.shape for part in result[1:4]], [(2,)] * 3)
            self.assertEqual([part.dtype.kind for part in result[1:4]], ["f", "b", "b"])
            self.check_resets_follow_the_last_seed(envs, envs.action_space.sample())
        self.assertTrue(envs.closed)
        envs.close()

    def test_one_that_cannot_be_made_leaves_nothing_behind(self) -> None:
        with unittest.mock.patch("sys.unraisablehook") as unraisable:
            self.assertIn("count is 9", self.message_of(clearway.InputError, lambda: clearway.vector_env("intersection", 9)))
            self.assertIn("nowhere", self.message_of(clearway.InputError, lambda: clearway.vector_env("nowhere", 2)))
            unraisable.assert_not_called()


class PettingZooTest(ConformanceCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.env = clearway.parallel_env("intersection", seeds=range(2))
        cls.addClassCleanup(cls.env.close)

    def actions_for(self, observations: dict) -> dict:
        actions = {}
        for agent in self.env.agents:
            legal = np.flatnonzero(observations[agent]["action_mask"])
            self.assertGreater(len(legal), 0)
            actions[agent] = random.choice(legal)  # noqa: S311
        return actions

    def test_class(self) -> None:
        env = self.env
        self.assertIsInstance(env, pettingzoo.ParallelEnv)
        self.assertIs(env.unwrapped, env)
        self.assertIs(type(env.metadata["name"]), str)
        self.assertEqual(env.max_num_agents, len(env.possible_agents))
        self.assertEqual(len(set(env.possible_agents)), len(env.possible_agents))
        env.max_cycles = 100  # the test sets it

    def test_two_episodes_of_the_parallel_api(self) -> None:
        env = self.env
        env.reset(seed=0, options={"options": 1})
        for _ in range(2):
            observations, infos = env.reset()
            self.assertIs(type(observations), dict)
            self.assertIs(type(infos), dict)
            self.assertEqual((set(observations), set(infos)), (set(env.agents), set(env.agents)))
            live, finished = set(env.agents), set()
            for _ in range(1000):
                parts = env.step(self.actions_for(observations))
                observations, rewards, terminated, truncated, infos = parts
                self.assertFalse(finished & set(env.agents), "nobody comes back")
                for part in parts:
                    self.assertIs(type(part), dict)
                    self.assertEqual(set(part), live)
                for agent in live:
                    self.assertIn(observations[agent], env.observation_space(agent))
                    self.assertIs(env.observation_space(agent), env.observation_space(agent))
                    self.assertIs(env.action_space(agent), env.action_space(agent))
                    self.assertIsInstance(env.observation_space(agent), spaces.Dict)
                    self.assertIsInstance(env.action_space(agent), spaces.Discrete)
                    self.assertEqual((type(terminated[agent]), type(truncated[agent]), type(infos[agent])), (bool, bool, dict))
                    self.assertTrue(np.isfinite(rewards[agent]))
                gone = {agent for agent in live if terminated[agent] or truncated[agent]}
                finished |= gone
                live -= gone
                self.assertEqual(set(env.agents), live)
                self.assertLessEqual(set(env.agents), set(env.possible_agents))
                self.assertEqual(env.num_agents, len(live))
                if not live:
                    break
            self.assertEqual(finished, set(env.possible_agents), "an episode ends for all")

    def test_two_of_the_same_seed_are_the_same_episode(self) -> None:
        with clearway.parallel_env("intersection", seeds=[0]) as one, clearway.parallel_env("intersection", seeds=[0]) as other:
            both = (one, other)
            one.reset(seed=7)  # another past
            for env in both:
                env.reset(seed=42)
                for number, agent in enumerate(env.agents):
                    env.action_space(agent).seed(42 + number)
                    env.observation_space(agent).seed(42 + number)
            self.check_equal(*(env.reset(seed=42) for env in both))
            while one.agents:  # to the end; illegal actions are sampled, too
                actions = [{agent: env.action_space(agent).sample() for agent in env.agents} for env in both]
                self.check_equal(*actions)
                self.check_equal(*(list(env.step(chosen)) for env, chosen in zip(both, actions)))
                self.assertEqual(one.agents, other.agents)

    def test_resets_follow_the_last_seed(self) -> None:
        self.check_resets_follow_the_last_seed(self.env, {})

    def test_their_own_test(self) -> None:
        if is_stand_in(pettingzoo):
            self.skipTest("pettingzoo is not installed (it is in no Debian package)")
        from pettingzoo.test import parallel_api_test, parallel_seed_test
        parallel_api_test(self.env, num_cycles=1000)
        parallel_seed_test(lambda: clearway.parallel_env("intersection", seeds=[0]))


if __name__ == "__main__":
    unittest.main()
