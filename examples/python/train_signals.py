"""Trains a policy for the intersection's signal by PPO (Schulman et al. 2017), and scores it against `corridor` on fresh seeds.

    python3 train_signals.py [--steps 200000] [--seeds 20] [--out runs/ppo]

Needs torch (Debian: python3-torch). The trained policy is written as a file of its own, weights included (OUT/trained.py), so that
its hash in the manifest is that of the weights, too; `clearway run intersection --policy OUT/trained.py:Trained` runs it. It decides
about signals alone, while `corridor` also clears lanes. Replications from 1000 on train; the constants below were chosen on study seed
2; study seed 3 scores.
"""
import argparse
import base64
import time
from pathlib import Path

import clearway
import numpy as np
import torch
from torch import nn

from signal_features import KEPT, features_of_observation

GAMMA, LAMBDA, CLIP, ROLLOUT, EPOCHS, BATCH = 0.9, 0.95, 0.2, 128, 6, 64
SCALE = 0.1  # of rewards, so that the value's gradient does not drown the policy's


class Net(nn.Module):
    def __init__(self, inputs: int, choices: int) -> None:
        super().__init__()
        self.body = nn.Sequential(nn.Linear(inputs, 32), nn.Tanh())
        self.choice, self.value = nn.Linear(32, choices), nn.Linear(32, 1)

    def forward(self, x, mask):
        hidden = self.body(x)
        logits = self.choice(hidden).masked_fill(mask == 0, -1e9)
        return torch.distributions.Categorical(logits=logits), self.value(hidden).squeeze(-1)


def inputs_of(observation, choices):
    return torch.from_numpy(features_of_observation(observation)), torch.from_numpy(observation["action_mask"][:, :choices])


def rollout(envs, net, observation, choices):
    """ROLLOUT choices of all environments, each kept for KEPT decisions, because a signal needs some seconds to change; returns
    tensors of shape (choices, environments) and the last observation."""
    kept = {name: [] for name in ("x", "mask", "action", "log_p", "value", "reward", "alive")}
    for _ in range(ROLLOUT):
        x, mask = inputs_of(observation, choices)
        with torch.no_grad():
            chances, value = net(x, mask)
            action = chances.sample()
        actions = np.zeros(envs.action_space.shape, dtype=np.int64)
        actions[:, 0] = action.numpy()
        gained, alive = np.zeros(envs.num_envs, dtype=np.float32), np.ones(envs.num_envs, dtype=bool)
        for _ in range(KEPT):
            observation, reward, terminated, truncated, _ = envs.step(actions)
            gained += alive * reward * SCALE
            alive &= ~(terminated | truncated)
            actions[~alive] = 0  # the next episode has begun
        for name, one in (("x", x), ("mask", mask), ("action", action), ("log_p", chances.log_prob(action)), ("value", value),
                          ("reward", torch.from_numpy(gained)), ("alive", torch.from_numpy(alive).float())):
            kept[name].append(one)
    with torch.no_grad():
        kept["value"].append(net(*inputs_of(observation, choices))[1])
    return {name: torch.stack(ones) for name, ones in kept.items()}, observation


def advantages(data):
    """Generalised advantage estimation (Schulman et al. 2016)."""
    steps, last = len(data["reward"]), 0.0
    result = torch.zeros_like(data["reward"])
    for step in reversed(range(steps)):
        error = data["reward"][step] + GAMMA * data["value"][step + 1] * data["alive"][step] - data["value"][step]
        last = error + GAMMA * LAMBDA * data["alive"][step] * last
        result[step] = last
    return result


def improve(net, optimiser, data):
    advantage = advantages(data)
    goal = (advantage + data["value"][:-1]).flatten()
    flat = {name: data[name].flatten(0, 1) for name in ("x", "mask", "action", "log_p")}
    advantage = ((advantage - advantage.mean()) / (advantage.std() + 1e-6)).flatten()
    for _ in range(EPOCHS):
        for rows in torch.randperm(len(goal)).split(BATCH):
            chances, value = net(flat["x"][rows], flat["mask"][rows])
            ratio = (chances.log_prob(flat["action"][rows]) - flat["log_p"][rows]).exp()
            gain = torch.min(ratio * advantage[rows], ratio.clamp(1 - CLIP, 1 + CLIP) * advantage[rows])
            loss = -gain.mean() + 0.5 * (value - goal[rows]).pow(2).mean() - 0.01 * chances.entropy().mean()
            optimiser.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(net.parameters(), 0.5)
            optimiser.step()


def write_policy(net: Net, folder: Path) -> Path:
    """The trained policy as one file: the template beside this file, with features and weights."""
    here = Path(__file__).parent
    weights = {name: tensor.detach().numpy() for name, tensor in net.state_dict().items() if not name.startswith("value")}
    text = {name: (array.shape, base64.b64encode(array.astype("<f4").tobytes()).decode()) for name, array in weights.items()}
    file = folder / "trained.py"
    file.write_text((here / "signal_features.py").read_text() + (here / "trained_policy.py").read_text().replace(
        "from signal_features import KEPT, features_of_belief, green_phases\n", "").replace("WEIGHTS = {}", f"WEIGHTS = {text!r}"))
    return file


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=200000)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--out", default="runs/ppo")
    arguments = parser.parse_args()
    folder = Path(arguments.out)
    folder.mkdir(parents=True, exist_ok=True)
    torch.manual_seed(1)
    torch.set_num_threads(1)
    begin, steps, rewards = time.monotonic(), 0, []
    with clearway.vector_env("intersection", 2, seeds=range(1000, 1008)) as envs:
        choices = int(envs.single_action_space.nvec[0])
        observation, _ = envs.reset()
        net = Net(features_of_observation(observation).shape[1], choices)
        optimiser = torch.optim.Adam(net.parameters(), lr=1e-3)
        while steps < arguments.steps:
            data, observation = rollout(envs, net, observation, choices)
            improve(net, optimiser, data)
            steps += ROLLOUT * KEPT * envs.num_envs
            rewards.append(float(data["reward"].mean()))
            print(f"{steps} steps, {time.monotonic() - begin:.0f} s: reward {rewards[-1] / (SCALE * KEPT):+.3f} s a step", flush=True)
    policy = write_policy(net, folder)
    print(f"trained in {time.monotonic() - begin:.0f} s; score on fresh seeds:")
    results = clearway.run("intersection", ["corridor", clearway.Condition("signals", policy="preempt_signals"),
                                            clearway.Condition("ppo", policy=f"{policy}:Trained")],
                           seeds=arguments.seeds, seed=3, out=folder / "study")
    for metric in ("emergency_travel_time_s", "others_time_loss_s"):
        for one in results.paired_differences(metric):
            print(one)


if __name__ == "__main__":
    main()
