"""Environments: the interface, seeds, equality with runs, and ends. What checkers of others assert: conformance_test."""
import gc
import json
import multiprocessing
import os
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path
from unittest import mock

import clearway
import numpy as np
from clearway import _spaces
from support import FolderCase, no_action, program


def finish(env: clearway.Env) -> dict:
    done = False
    while not done:
        _, _, terminated, truncated, info = env.step(no_action(env))
        done = terminated or truncated
    return info


def children(of: int) -> list[int]:
    """All living processes below a process."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if words[0] != "Z" and int(words[1]) == of:
            found += [int(process.name), *children(int(process.name))]
    return found


def wait_until(holds, seconds: float = 20.0) -> bool:  # noqa: ANN001
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if holds():
            return True
        time.sleep(0.05)
    return False


class InterfaceTest(FolderCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.env = clearway.env("intersection", seeds=[0], render_mode="ansi")
        cls.addClassCleanup(cls.env.close)

    def test_spaces_and_environments_print_what_they_are(self) -> None:
        own = {_spaces._Box(-1, 2, (3,), np.float32): "Box(-1.0, 2.0, (3,), float32)", _spaces._Discrete(4): "Discrete(4)",
               _spaces._MultiDiscrete([3, 16]): "MultiDiscrete([ 3 16])", _spaces._Dict({"a": _spaces._Discrete(2)}): "Dict('a': Discrete(2))"}
        for space, text in own.items():
            self.assertEqual(repr(space), text)
        for make, text in ((clearway.env, "<Env of intersection>"), (clearway.parallel_env, "<ParallelEnv of intersection: 9 agents>"),
                           (lambda name, **given: clearway.vector_env(name, 1, **given), "<VectorEnv of 1 times intersection>")):
            with make("intersection", seeds=[0]) as made:
                self.assertEqual(repr(made), text)

    def test_reset_and_step_return_what_the_spaces_say(self) -> None:
        observation, info = self.env.reset(seed=0)
        self.assertIn(observation, self.env.observation_space)
        self.assertIsInstance(info, dict)
        for _ in range(5):
            action = np.array([space_choice(mask) for mask in self.env.action_masks()])
            self.assertIn(action, self.env.action_space)
            observation, reward, terminated, truncated, info = self.env.step(action)
            self.assertIn(observation, self.env.observation_space)
            self.assertEqual([type(value) for value in (reward, terminated, truncated, info)], [float, bool, bool, dict])
            self.assertTrue(np.isfinite(reward))
            self.assertLessEqual(reward, 0.0)
            self.assertEqual(info["illegal_actions"], 0)
            self.assertAlmostEqual(reward, -info["emergency_delay_s"] - 0.01 * info["others_delay_s"])

    def test_a_step_is_a_policy_period_and_costs_at_most_that_much_delay(self) -> None:
        _, before = self.env.reset(seed=0)
        _, _, _, _, after = self.env.step(no_action(self.env))
        self.assertEqual(after["time_s"] - before["time_s"], 0.5)
        self.assertLessEqual(after["emergency_delay_s"], 0.5 * 2)

    def test_the_observation_has_the_vehicle_and_its_neighbours(self) -> None:
        observation, _ = self.env.reset(seed=0)
        self.assertEqual(observation["emergency"][0], 1.0)
        count = int(observation["vehicle_mask"].sum())
        self.assertGreater(count, 0)
        self.assertTrue((observation["vehicles"][count:] == 0).all())
        distances = np.hypot(*observation["vehicles"][:count, :2].T)
        self.assertTrue((np.diff(distances) >= -1e-3).all())
        links = int(observation["edge_mask"].sum())
        self.assertTrue((observation["edges"][:, :links] < count).all())
        ends = observation["vehicles"][observation["edges"][:, :links], :2]
        np.testing.assert_allclose(np.hypot(*(ends[0] - ends[1]).T), observation["edge_features"][:links, 0], atol=0.01)

    def test_the_same_seed_is_the_same_episode_to_the_bit(self) -> None:
        rng = np.random.default_rng(3)
        actions, first = [], [self.env.reset(seed=7)[0]]
        for _ in range(20):
            actions.append(np.array([rng.choice(np.flatnonzero(mask)) for mask in self.env.action_masks()]))
            first.append(self.env.step(actions[-1])[0])
        second = [self.env.reset(seed=7)[0], *(self.env.step(action)[0] for action in actions)]
        for left, right in zip(first, second):
            for name in left:
                np.testing.assert_array_equal(left[name], right[name])
        other = self.env.reset(seed=8)[0]
        self.assertFalse(np.array_equal(other["vehicles"], first[0]["vehicles"]))

    def test_generators_follow_the_seed(self) -> None:
        self.env.reset(seed=123)
        state = self.env._np_random.bit_generator.state
        self.env.reset(seed=123)
        self.assertEqual(self.env._np_random.bit_generator.state, state)
        self.env.reset(seed=456)
        self.assertNotEqual(self.env._np_random.bit_generator.state, state)

    def test_a_held_phase_shows_at_the_signal(self) -> None:
        shares = []
        for phase in (1, 2):
            observation, _ = self.env.reset(seed=0)
            while observation["signals"][0, 0] == 0.0:
                self.assertFalse(self.env.action_masks()[0][1:].any(), "nothing to hold for an EV that is far away")
                observation = self.env.step(no_action(self.env))[0]
            self.assertTrue(self.env.action_masks()[0].all())
            served = observation["signal_phases"][0, phase - 1]
            for _ in range(14):  # 7 s: yellow, all red, green
                observation, _, terminated, _, info = self.env.step(np.array([phase] + [0] * 8))
                self.assertEqual((terminated, info["illegal_actions"]), (False, 0))
            shares.append(observation["signals"][0, 2] if observation["signals"][0, 0] else 1.0)
            self.assertEqual(served, shares[-1], "a phase serves the EV when holding it shows it green")
        self.assertEqual(sorted(shares), [0.0, 1.0])

    def test_illegal_actions_are_counted_and_wrong_ones_refused(self) -> None:
        self.env.reset(seed=0)
        masks = self.env.action_masks()
        illegal = next((place, int(np.argmin(mask))) for place, mask in enumerate(masks) if not mask.all())
        action = no_action(self.env)
        action[illegal[0]] = illegal[1]
        self.assertEqual(self.env.step(action)[4]["illegal_actions"], 1)
        for wrong, says in ((np.zeros(3, int), "shape (3,)"), (np.full(9, 0.5), "float64"), (np.full(9, np.nan), "float64"),
                            (np.full(9, 99), "action 0 is 99"), (np.full(9, -1), "action 0 is -1")):
            self.assertIn(says, self.message_of(clearway.InputError, lambda wrong=wrong: self.env.step(wrong)))
        self.env.step(no_action(self.env))  # it goes on

    def test_renders_a_line(self) -> None:
        self.env.reset(seed=0)
        self.assertRegex(self.env.render(), r"\d+\.\d\d s: EV at .* m/s")

    def test_after_the_end_a_step_is_refused(self) -> None:
        self.env.reset(seed=0)
        finish(self.env)
        self.assertIn("call reset()", self.message_of(clearway.ClearwayError, lambda: self.env.step(no_action(self.env))))
        self.env.reset(seed=0)
        self.env.step(no_action(self.env))

    def test_wrong_arguments_are_told(self) -> None:
        for arguments, says in (({"until": "noon"}, "emergency, end"), ({"render_mode": "human"}, "ansi"), ({"seeds": []}, "at least one"),
                                ({"seeds": [-1]}, "-1"), ({"others_weight": float("nan")}, "nan"), ({"failure": "B99"}, "B99"),
                                ({"policy": "nothing"}, "nothing"), ({"sparse": True}, "no keyword 'sparse'"),
                                ({"densty": 2}, "Did you mean 'density'?"),
                                ({"variant": "thick"}, "allowed: standard, dense"), ({"variant": True}, "variant: \"True\""),
                                ({"step_length_s": None}, "step_length_s: \"None\""), ({"density": True}, "density: \"True\""),
                                ({"horizon_s": float("nan")}, "horizon"), ({"step_length_s": 7}, "7"),
                                ({"ways": 9}, "ways is 9 (allowed: a whole number from 0 to 8)"), ({"ways": -1}, "ways is -1"),
                                ({"ways": True}, "ways is True"), ({"ways": 2.5}, "ways is 2.5"), ({"ways": "2"}, "ways is '2'"),
                                ({"seeds": 4}, "seeds are 4"), ({"seeds": None}, "seeds are None"), ({"policy": 3}, "is 3"),
                                ({"set": ["a"]}, "set is ['a']"), ({"replication": 3}, "no keyword 'replication'. Did you mean 'seeds'?")):
            self.assertIn(says, self.message_of(clearway.InputError, lambda: clearway.env("intersection", **arguments)))
        self.assertIn("nowhere", self.message_of(clearway.InputError, lambda: clearway.env("nowhere")))
        self.assertIn("seed is 'a'", self.message_of(clearway.InputError, lambda: self.env.reset(seed="a")))


def space_choice(mask: np.ndarray) -> int:
    return int(np.flatnonzero(mask)[-1])


class EqualRunTest(FolderCase):
    def test_an_episode_under_a_policy_is_the_run_of_that_condition(self) -> None:
        results = clearway.run("intersection", [clearway.Condition("faulty", policy="corridor", failure="B10",
                                                                   predictor="dead_reckoning"), "corridor"], seeds=2, out="runs")
        # Ways that nobody takes change nothing.
        for name, part in (("corridor", {}), ("faulty", {"failure": "B10", "predictor": "dead_reckoning", "ways": 8})):
            run = results.runs.where(condition=name, replication=1)
            with clearway.env("intersection", policy="corridor", seeds=[1], until="end", **part) as env:
                env.reset()
                info = finish(env)
                self.assertEqual(info["trace_hash"], run["trace_hash"][0])
                for metric, value in info["metrics"].items():
                    stored = run[metric][0]
                    self.assertTrue(stored == value or (value is None and np.isnan(stored)), metric)
                env.reset()
                self.assertEqual(finish(env)["trace_hash"], run["trace_hash"][0])


    def test_the_words_of_a_run_are_those_of_an_environment(self) -> None:
        words = {"variant": "dense", "step_length_s": 0.5, "automated_share": 0.5, "density": 0.5, "road_limit_kmh": 50, "horizon_s": 400,
                 "car_following": "idm", "idm": "treiber", "driver_spread": 0.1, "siren_compliance": 0.2, "road_speed_factor": 0.9,
                 "friction": 0.8, "time_to_teleport_s": 200, "traffic_kinds": "car=8,truck=2", "emergency_kinds": "police_car=1",
                 "pedestrians_per_hour": 10, "warm_up_s": 60, "incident": "none"}
        listed = json.loads(program("list", "scenario-keys", "--json"))
        overrides = {row["name"]: row.get("words", [row.get("minimum")])[0] for row in listed if row["table"] == "Overrides"}
        self.assertLessEqual(words.keys(), overrides.keys())
        words = {**overrides, **words}  # also those that are newer than this test
        results = clearway.run("intersection", ["corridor"], seeds=1, out="runs", **words)
        run = results.runs.where(condition="corridor")
        with clearway.env("intersection", policy="corridor", seeds=[0], until="end", **words) as env:
            env.reset()
            self.assertEqual(finish(env)["trace_hash"], run["trace_hash"][0])
        with clearway.env("intersection", policy="corridor", seeds=[0], until="end", variant="standard") as env:
            env.reset()
            self.assertNotEqual(finish(env)["trace_hash"], run["trace_hash"][0])


class WaysTest(FolderCase):
    """The way of the emergency vehicle as the last part of an action."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.env = clearway.env("grid_signals", seeds=[0], ways=3, until="end")
        cls.addClassCleanup(cls.env.close)

    def choice(self, row: int, env: clearway.Env | None = None) -> np.ndarray:
        """An action that takes a row of the ways."""
        action = no_action(env or self.env)
        action[-1] = 1 + row
        return action

    def test_spaces_have_them_only_where_they_are_wanted(self) -> None:
        with clearway.env("grid_signals", seeds=[0]) as without:
            self.assertEqual(self.env.action_space.nvec.tolist(), [*without.action_space.nvec.tolist(), 4])
            usual, _ = without.reset(seed=0)
            observation, _ = self.env.reset(seed=0)
            self.assertIn(observation, self.env.observation_space)
            self.assertEqual(observation.keys() - usual.keys(), {"ways", "way_mask"})
            for name, array in usual.items():
                np.testing.assert_array_equal(observation[name][:len(array)], array)
        self.assertEqual((observation["ways"].shape, observation["ways"].dtype), ((3, 3), np.float32))
        self.assertEqual((observation["way_mask"].shape, observation["way_mask"].dtype), ((3,), np.uint8))
        self.assertEqual(self.env.action_masks()[-1].tolist(), [1, *observation["way_mask"]])
        self.assertIn("then one for the way", self.message_of(clearway.InputError, lambda: self.env.step(np.zeros(3, int))))

    def test_they_are_fastest_first_and_one_that_is_chosen_is_taken(self) -> None:
        observation, _ = self.env.reset(seed=0)
        there = observation["way_mask"].astype(bool)
        times_s, lengths_m, shares = observation["ways"][there].T
        self.assertGreater(len(times_s), 1)
        self.assertTrue((np.diff(times_s) >= 0.0).all() and (times_s > 0.0).all() and (lengths_m > 0.0).all())
        self.assertTrue(((shares > 0.0) & (shares <= 1.0)).all())
        row = int(np.argmin(shares))
        self.assertLess(shares[row], 1.0)
        observation, _, _, _, info = self.env.step(self.choice(row))
        self.assertEqual(info["illegal_actions"], 0)
        (present,) = np.flatnonzero(observation["ways"][:, 2] == 1.0)
        self.assertAlmostEqual(observation["ways"][present, 1], lengths_m[row], delta=20.0)  # it was driven on meanwhile
        self.assertGreater(abs(lengths_m[shares == 1.0] - lengths_m[row]), 100.0, "not the way that it had")
        metrics = finish(self.env)["metrics"]
        self.assertEqual((metrics["leases_issued"], metrics["leases_refused"]), (1, 0))

    def test_the_same_choices_are_the_same_episode_to_the_bit(self) -> None:
        episodes = []
        for _ in range(2):
            rng, seen = np.random.default_rng(5), [self.env.reset(seed=0)[0]]
            for _ in range(60):
                mask = self.env.action_masks()[-1]
                seen.append(self.env.step(self.choice(int(rng.choice(np.flatnonzero(mask))) - 1))[0])
            episodes.append((seen, finish(self.env)["trace_hash"]))
        for left, right in zip(*(seen for seen, _ in episodes)):
            for name in left:
                np.testing.assert_array_equal(left[name], right[name])
        self.assertEqual(episodes[0][1], episodes[1][1])
        self.env.reset(seed=0)
        self.assertNotEqual(finish(self.env)["trace_hash"], episodes[0][1], "other ways were driven")

    def test_one_that_is_not_there_does_nothing_and_is_counted(self) -> None:
        with clearway.env("merge", seeds=[0], ways=8) as env:
            observation, _ = env.reset()
            self.assertFalse(observation["way_mask"][-1], "a motorway has few ways")
            self.assertEqual(env.step(self.choice(7, env))[4]["illegal_actions"], 1)
            self.assertEqual(env.step(no_action(env))[4]["illegal_actions"], 0)

    def test_many_at_a_time_and_an_agent_of_its_own_have_them(self) -> None:
        with clearway.vector_env("grid_signals", 2, seeds=[0, 1], ways=3) as both:
            actions = np.zeros(both.action_space.shape, dtype=np.int64)
            actions[:, -1] = 1
            observations, _ = both.reset()
            self.assertIn(observations, both.observation_space)
            expected, _ = self.env.reset(seed=0)
            for _ in range(5):
                for name, array in expected.items():
                    np.testing.assert_array_equal(observations[name][0], array)
                observations, _, _, _, infos = both.step(actions)
                expected, _, _, _, info = self.env.step(actions[0])
                self.assertEqual(infos["illegal_actions"][0], info["illegal_actions"])
        with clearway.parallel_env("grid_signals", seeds=[0], ways=3) as agents:
            observations, _ = agents.reset()
            expected, _ = self.env.reset(seed=0)
            self.assertEqual(agents.possible_agents[-2:], ["automated:7", "way"])
            self.assertEqual(agents.action_space("way").n, 4)
            for _ in range(5):
                self.assertIn(observations["way"], agents.observation_space("way"))
                self.assertEqual(observations["way"]["action_mask"].tolist(), [1, *expected["way_mask"]])
                np.testing.assert_array_equal(observations["way"]["observation"]["ways"], expected["ways"])
                observations, _, _, _, infos = agents.step({"way": 1})
                expected, _, _, _, info = self.env.step(actions[0])
                self.assertEqual(infos["way"]["illegal_actions"], info["illegal_actions"])
            self.assertIn("the action of way is 4", self.message_of(clearway.InputError, lambda: agents.step({"way": 4})))


class EndTest(FolderCase):
    def test_close_ends_all_processes_and_may_be_repeated(self) -> None:
        before = set(children(os.getpid()))
        env = clearway.env("intersection", seeds=[0, 1])
        env.reset()
        env.reset()
        self.assertEqual(len(set(children(os.getpid())) - before), 4)  # two workers, an episode each
        folder = env._folder
        env.close()
        env.close()
        self.assertTrue(wait_until(lambda: set(children(os.getpid())) <= before))
        self.assertFalse(folder.exists())
        self.assertIn("is closed", self.message_of(clearway.ClearwayError, env.reset))
        self.assertIn("is closed", self.message_of(clearway.ClearwayError, lambda: env.step(no_action(env))))
        self.assertIsNone(env.render())

    def test_a_step_before_the_first_reset_is_refused(self) -> None:
        with clearway.env("intersection", seeds=[0]) as env:
            self.assertIn("call reset() first", self.message_of(clearway.ClearwayError, lambda: env.step(no_action(env))))

    def test_before_the_first_reset_nothing_is_there(self) -> None:
        with clearway.env("intersection", seeds=[0]) as env, clearway.parallel_env("intersection", seeds=[0]) as agents_env:
            for call in (env.action_masks, agents_env.state):
                self.assertIn("call reset() first", self.message_of(clearway.ClearwayError, call))
            self.assertIn("send()", self.message_of(clearway.ClearwayError, env.receive))

    def test_an_interrupted_step_does_not_disturb_the_next_episode(self) -> None:
        with clearway.env("intersection", seeds=[0]) as env:
            def episode() -> list[float]:
                env.reset(seed=0)
                return [env.step(no_action(env))[4]["time_s"] for _ in range(4)]

            expected = episode()
            env.reset(seed=0)
            with mock.patch.object(env._worker._channel, "wait", side_effect=KeyboardInterrupt):  # as Ctrl-C does
                with self.assertRaises(KeyboardInterrupt):
                    env.step(no_action(env))
            self.assertIn("reset()", self.message_of(clearway.ClearwayError, lambda: env.step(no_action(env))))
            self.assertEqual(episode(), expected)

    def test_an_episode_waits_for_its_agent_as_long_as_that_takes(self) -> None:
        with clearway.env("intersection", seeds=[0]) as env:
            (job,) = env._folder.rglob("job.json")
            self.assertGreaterEqual(json.loads(job.read_text())["wall_limit_s"], 1e9)

    def test_an_interrupted_start_leaves_no_process(self) -> None:
        before = set(children(os.getpid()))
        with mock.patch("clearway._channel.Channel.wait", side_effect=KeyboardInterrupt), self.assertRaises(KeyboardInterrupt):
            clearway.env("intersection", seeds=[0])
        self.assertTrue(wait_until(lambda: set(children(os.getpid())) <= before))

    def test_a_forgotten_environment_ends(self) -> None:
        before = set(children(os.getpid()))
        env = clearway.env("intersection", seeds=[0])
        env.reset()
        del env
        gc.collect()
        self.assertTrue(wait_until(lambda: set(children(os.getpid())) <= before))

    def test_a_forked_child_is_refused_and_does_not_keep_workers_alive(self) -> None:
        env = clearway.env("intersection", seeds=[0])
        self.addCleanup(env.close)
        env.reset()
        queue = multiprocessing.get_context("fork").Queue()

        def use() -> None:
            for call in (env.reset, lambda: env.step(no_action(env))):
                try:
                    call()
                except clearway.ClearwayError as error:
                    queue.put(str(error))
            env.close()  # of no effect on the parent's

        child = multiprocessing.get_context("fork").Process(target=use)
        child.start()
        for _ in range(2):
            self.assertIn("make one in this process", queue.get(timeout=60))
        child.join()
        self.assertEqual(child.exitcode, 0)
        env.step(no_action(env))  # the parent's goes on

    def test_killed_parents_leave_no_process(self) -> None:
        parent = subprocess.Popen([sys.executable, "-c", "import clearway, time; env = clearway.env('intersection', seeds=[0]); "
                                   "env.reset(); print('ready', flush=True); time.sleep(600)"], stdout=subprocess.PIPE, text=True)
        self.assertEqual(parent.stdout.readline().strip(), "ready")
        below = children(parent.pid)
        self.assertEqual(len(below), 2)
        parent.send_signal(signal.SIGKILL)
        parent.wait()
        parent.stdout.close()
        self.assertTrue(wait_until(lambda: not any(Path(f"/proc/{pid}").exists() for pid in below)))

    def test_a_killed_worker_is_told_and_a_reset_starts_another(self) -> None:
        env = clearway.env("intersection", seeds=[0])
        self.addCleanup(env.close)
        env.reset()
        for pid in children(os.getpid()):
            os.kill(pid, signal.SIGKILL)
        self.assertIn("ended with -9", self.message_of(clearway.ClearwayError, lambda: env.step(no_action(env))))
        env.reset()
        env.step(no_action(env))

    def test_a_killed_episode_is_told(self) -> None:
        env = clearway.env("intersection", seeds=[0])
        self.addCleanup(env.close)
        env.reset()
        os.kill(children(os.getpid())[-1], signal.SIGKILL)
        self.assertIn("killed by signal 9", self.message_of(clearway.ClearwayError, lambda: env.step(no_action(env))))


if __name__ == "__main__":
    unittest.main()
