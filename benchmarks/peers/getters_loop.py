"""A loop as the dissertation's: TraCI over a socket, a getter for each number of each vehicle, all pairs, GraphSAGENet in PyTorch."""
import random

import numpy as np
import torch
import traci

import peer


class GraphSAGENet(torch.nn.Module):
    """Two SAGEConv (mean), product of a pair's ends, Linear, ReLU, Linear: chapters 5.1 and 5.2."""

    def __init__(self, weights):
        super().__init__()
        self.tensors = {name: torch.from_numpy(values) for name, values in weights.items()}

    def linear(self, name, rows):
        return torch.nn.functional.linear(rows, self.tensors[f"{name}.weight"], self.tensors.get(f"{name}.bias"))

    def convolve(self, name, rows, source, target):
        total = torch.zeros_like(rows).index_add_(0, target, rows[source])
        count = torch.bincount(target, minlength=len(rows)).clamp(min=1)
        return self.linear(f"{name}.lin_l", total / count[:, None]) + self.linear(f"{name}.lin_r", rows)

    def forward(self, rows, source, target, left, right):
        hidden = self.convolve("graphsage.conv1", rows, source, target)
        embedding = self.convolve("graphsage.conv2", hidden, source, target)
        decoded = torch.relu(self.linear("nn.fc1", embedding[left] * embedding[right]))
        return torch.sigmoid(self.linear("nn.fc2", decoded))[:, 0]


class GettersLoop:
    def __init__(self, sumo, run):
        self.sumo, self.run = sumo, run
        self.net = GraphSAGENet(peer.read_weights(run.weights))
        self.random = random.Random(run.seed)
        self.classes, self.dark, self.reports = {}, {}, {}
        torch.set_num_threads(1)

    def read(self):
        """The state of every vehicle on the road: (x, y), speed, heading, lane, place on it."""
        ask = self.sumo.vehicle
        vehicles = {}
        for name in ask.getIDList():
            if name not in self.classes:
                self.classes[name] = peer.class_of(self.sumo, name)
            vehicles[name] = (ask.getPosition(name), ask.getSpeed(name), ask.getAngle(name), ask.getLaneID(name),
                              ask.getLanePosition(name))
        return vehicles

    def report(self, vehicles, now_s):
        """Keeps the last report of each vehicle that is still there, and when it was made."""
        self.reports = {name: report for name, report in self.reports.items() if name in vehicles}
        if not self.run.reports_at(now_s):
            return
        for name, state in vehicles.items():
            if self.run.fails and (name not in self.dark or self.random.random() < peer.DRAWN_ANEW):
                self.dark[name] = self.random.random() < peer.DARK_SHARE
            if not self.dark.get(name, False):
                self.reports[name] = (state, now_s)

    def step(self, now_s):
        self.report(self.read(), now_s)
        names = list(self.reports)
        if not names:
            return 0
        states = [state for state, _ in self.reports.values()]
        last_m = np.array([state[0] for state in states])
        speed_mps = np.array([state[1] for state in states])
        age_s = np.array([now_s - time_s for _, time_s in self.reports.values()])
        xy_m = peer.places(last_m, speed_mps, np.array([state[2] for state in states]), age_s)
        classes = np.array([self.classes[name] for name in names])
        known = np.array([not self.dark.get(name, False) for name in names])
        links = self.links(last_m, xy_m, age_s, classes, known)
        if self.run.acts:
            peer.make_room(self.sumo, names, classes, [state[3] for state in states], np.array([state[4] for state in states]),
                           speed_mps, links)
        return len(links)

    def links(self, last_m, xy_m, age_s, classes, known):
        """Pairs of rows, left < right: those seen, and of the others those that the net believes."""
        now_m = np.linalg.norm(xy_m[:, None] - xy_m[None, :], axis=2)
        then_m = np.linalg.norm(last_m[:, None] - last_m[None, :], axis=2)
        allowed = np.triu(classes[:, None] != classes[None, :])
        both_known = known[:, None] & known[None, :]
        seen = np.argwhere(allowed & both_known & (now_m < peer.RADIUS_M))
        asked = np.argwhere(allowed & ~both_known & (np.minimum(now_m, then_m) < peer.REACH_M))
        if not len(asked):
            return seen
        messages = torch.from_numpy(np.concatenate((seen, seen[:, ::-1])))
        pairs = torch.from_numpy(asked)
        with torch.no_grad():
            believed = self.net(torch.from_numpy(peer.features_of(xy_m, age_s)), messages[:, 0], messages[:, 1], pairs[:, 0],
                                pairs[:, 1])
        return np.concatenate((seen, asked[(believed >= peer.LINKED).numpy()]))


if __name__ == "__main__":
    peer.drive(traci, GettersLoop)
