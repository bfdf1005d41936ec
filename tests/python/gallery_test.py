"""Every example of examples/python runs and says what it promises."""
import errno
import importlib.util
import json
import os
import subprocess
import sys
import unittest
from unittest import mock

import clearway
import numpy as np
from support import FolderCase, PROGRAMS, SOURCE, program, told_when

GALLERY = SOURCE / "examples/python"


class GalleryTest(FolderCase):
    def example(self, *words: str) -> str:
        ended = subprocess.run([sys.executable, str(GALLERY / words[0]), *words[1:]], capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        return ended.stdout

    def test_first_steps(self) -> None:
        self.assertRegex(self.example("first_steps.py", "runs"), r"corridor - Baseline, emergency_travel_time_s: -\d+\.\d\d too few seeds")

    def test_study_with_plot_draws_each_condition(self) -> None:
        said = self.example("study_with_plot.py", "runs", "1")
        gains = {one.condition: -one.difference for one in clearway.open("runs").paired_differences("emergency_travel_time_s")}
        self.assertEqual(set(gains), {"signals", "lanes", "mine"})
        self.assertGreater(gains["signals"], 10.0)
        self.assertGreater(gains["mine"], 10.0)
        self.assertNotEqual(gains["lanes"], 0.0)  # automated vehicles did leave the lane
        if importlib.util.find_spec("matplotlib"):
            self.assertGreater((self.folder / "runs/study.png").stat().st_size, 5000)
        else:
            for condition, gain in gains.items():
                self.assertIn(f"{condition:>8} {-gain:+7.1f} s", said)

    def test_the_policy_and_the_predictor_run_together(self) -> None:
        program("run", "intersection", "--policy", f"{GALLERY}/yield_policy.py:Yield", "--failure", "B10", "--predictor",
                f"{GALLERY}/distance_predictor.py:ByDistance", "--name", "mine", "--seeds", "1", "--no-solo", "--out", "runs")
        results = clearway.open("runs")
        leases = results.leases.where(condition="mine", policy="Yield", outcome="acted")
        self.assertIn("hold_green", set(leases["action"]))
        self.assertGreater(results.runs.where(condition="mine")["dark_links_true_positive"][0], 0)

    @unittest.skipUnless(importlib.util.find_spec("torch"), "torch is not installed (Debian: python3-torch)")
    def test_a_policy_is_trained_and_scored(self) -> None:
        said = self.example("train_signals.py", "--steps", "512", "--seeds", "1", "--out", "ppo")
        for condition in ("corridor", "signals", "ppo"):
            self.assertIn(f"intersection: {condition} - Baseline, others_time_loss_s", said)
        self.assertTrue(os.path.exists("ppo/trained.py"))
        self.assertEqual(clearway.open("ppo/study").errors.row_count, 0)

    def test_the_notebook_runs(self) -> None:
        cells = json.loads((GALLERY / "first_steps.ipynb").read_text())["cells"]
        if importlib.util.find_spec("nbconvert") and importlib.util.find_spec("ipykernel"):
            subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output-dir", ".",
                            str(GALLERY / "first_steps.ipynb")], check=True)
            return
        # Without Jupyter its cells run one after the other; %%writefile is the only magic that they use.
        space: dict = {}
        for cell in cells:
            text = "".join(cell["source"])
            if cell["cell_type"] != "code":
                continue
            if text.startswith("%%writefile "):
                first, _, rest = text.partition("\n")
                self.write(first.split()[1], rest)
            else:
                exec(compile(text.replace("seeds=5", "seeds=1"), "cell", "exec"), space)  # noqa: S102
        self.assertGreater(space["lost_s"], 0.0)


def has_torch() -> bool:
    return importlib.util.find_spec("torch") is not None


class TorchTest(FolderCase):
    def test_weights_of_the_dissertations_net_are_a_predictor(self) -> None:
        subprocess.run([sys.executable, str(SOURCE / "tests/prediction/write_pth.py"), "."], check=True)
        results = clearway.run("intersection", [
            clearway.Condition("net", policy="dissertation", failure="B10", predictor="graphsage_corrected",
                               model="good.pth")], seeds=1, out="runs")
        self.assertEqual(results.errors.row_count, 0)
        self.assertIn(f"{self.folder}/good.pth", (self.folder / "runs/manifest.json").read_text())
        said = self.refusal_of("good.pth")  # with torch or without it
        self.assertIn("good.pth", said)

    def test_without_torch_a_file_is_refused_in_one_message(self) -> None:
        (self.folder / "hidden").mkdir()
        self.write("hidden/torch.py", "raise ImportError('as if it were not installed')\n")
        (self.folder / "net.pt").write_bytes(b"nothing")
        said = self.refusal_of("net.pt", PYTHONPATH=f"{self.folder}/hidden:{os.environ['PYTHONPATH']}")
        self.assertIn("torch is not installed (Debian: python3-torch)", said)

    def refusal_of(self, file: str, **environment: str) -> str:
        """What a run with this file as predictor says: which option takes weights, and no traceback."""
        ended = subprocess.run([str(PROGRAMS / "clearway"), "run", "intersection", "--predictor", file, "--policy", "corridor",
                                "--out", "other"], capture_output=True, text=True, check=False, env=os.environ | environment)
        self.assertEqual(ended.returncode, 3, ended.stderr)
        self.assertIn(f"--predictor graphsage_corrected --model {self.folder / file}", ended.stderr)
        self.assertNotIn("Traceback", ended.stderr)
        return ended.stderr

    @unittest.skipUnless(has_torch(), "torch is not installed (Debian: python3-torch)")
    def test_a_torch_script_is_a_predictor(self) -> None:
        import torch

        class Near(torch.nn.Module):
            def forward(self, x, edge_index, pairs, pair_features):  # noqa: ANN001, ANN201
                return (pair_features[:, 1] < 1.0).to(torch.float32)

        torch.jit.script(Near()).save("near.pt")
        self.write("same.py", "class Near:\n    def predict(self, o):\n        return o.pair_dead_reckoned_m < o.link_radius_m\n")
        results = clearway.run("intersection", [
            clearway.Condition(name, policy="corridor", failure="B10", predictor=predictor)
            for name, predictor in (("script", "near.pt"), ("plain", "same.py:Near"))], seeds=1, out="runs")
        self.assertEqual(results.errors.row_count, 0)
        script, plain = (results.runs.where(condition=name) for name in ("script", "plain"))
        self.assertEqual(script["trace_hash"][0], plain["trace_hash"][0])
        self.assertEqual(script["dark_links_true_positive"][0], plain["dark_links_true_positive"][0])
        self.assertGreater(plain["dark_links_true_positive"][0], 0)
        torch.jit.save(torch.jit.script(Near()), "odd.pt", _extra_files={"inputs": "odd"})
        self.assertIn('inputs "odd" are not known (allowed: observation, dataset)', self.message_of(
            clearway.InputError, lambda: clearway.run(
                "intersection", [clearway.Condition("no", policy="corridor", predictor="odd.pt")], seeds=1, out="other")))
        self.assertRegex(told_when("read", "EIO", self.folder / "near.pt", "clearway.torchscript.TorchScript('near.pt')"),
                         "^EnvironmentFault: near.pt: cannot be read: Input/output error")
        no_memory = RuntimeError(f"DefaultCPUAllocator: {os.strerror(errno.ENOMEM)}")
        with mock.patch("torch.jit.load", side_effect=no_memory), self.assertRaises(RuntimeError) as raised:
            clearway.torchscript.TorchScript("near.pt")
        self.assertIs(raised.exception, no_memory)
        (self.folder / "no.pt").write_bytes(b"nothing")
        self.assertIn("is not a TorchScript file", self.message_of(clearway.InputError, lambda: clearway.run(
            "intersection", [clearway.Condition("no", policy="corridor", predictor="no.pt")], seeds=1, out="other")))
        self.assertIn("near.reach is unknown", self.message_of(clearway.InputError, lambda: clearway.run(
            "intersection", [clearway.Condition("no", policy="corridor", predictor="near.pt", set={"near.reach": 1})], seeds=1,
            out="other")))

    @unittest.skipUnless(has_torch(), "torch is not installed (Debian: python3-torch)")
    def test_a_torch_script_of_a_data_set_is_given_what_the_data_set_holds(self) -> None:
        import torch

        class Near(torch.nn.Module):
            def forward(self, x, edge_index, pairs, pair_features):  # noqa: ANN001, ANN201
                return (pair_features[:, 0] + x.shape[1] < 55.0).to(torch.float32)

        torch.jit.save(torch.jit.script(Near()), "near.pt", _extra_files={"inputs": "dataset"})
        self.write("seen.py", f"""
import json
from clearway.torchscript import TorchScript, dataset_node_features, dataset_pair_features

class Seen(TorchScript):
    def __init__(self):
        super().__init__({str(self.folder / 'near.pt')!r})

    def predict(self, observation):
        answer, distance = super().predict(observation), dataset_pair_features(observation)
        assert (answer == (distance[:, 0] + 5 < 55)).all()
        pairs = dict(zip(map(str, observation.pairs.T.tolist()), distance[:, 0].tolist()))
        with open({str(self.folder / 'seen.json')!r}, "a") as file:
            file.write(json.dumps([observation.time_s, dataset_node_features(observation).tolist(), pairs]) + "\\n")
        return answer
""")
        words = [str(PROGRAMS / "clearway"), "links"]
        subprocess.run([*words, "dataset", "intersection", "--samples", "--failure", "B10", "--seeds", "1", "--out", "data"], check=True,
                       capture_output=True)
        subprocess.run([*words, "evaluate", "intersection", "--failure", "B10", "--seeds", "1", "--validation-seeds", "1", "--predictor",
                        "seen.py:Seen"], check=True, capture_output=True)
        seen: dict[float, list] = {}  # of the replication in the data set, and of one for validation
        for time_s, x, pairs in map(json.loads, (self.folder / "seen.json").read_text().splitlines()):
            seen.setdefault(time_s, []).append((np.array(x), pairs))
        samples = [sample for sample in clearway.dataset("data") if sample.origin["time_s"] in seen]
        self.assertGreater(len(samples), 20)
        for sample in samples:
            same = [pairs for x, pairs in seen[sample.origin["time_s"]] if x.shape == sample.x.shape and np.allclose(x, sample.x, atol=1e-4)]
            self.assertTrue(same, sample.origin)
            for pair, distance in zip(sample.edge_label_index.T.tolist(), sample.edge_label_attr[:, 0]):
                self.assertAlmostEqual(same[0][str(pair)], distance, 3)


if __name__ == "__main__":
    unittest.main()
