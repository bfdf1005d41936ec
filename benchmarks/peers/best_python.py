"""The best loop in Python that was found: libsumo in this process, arrays kept between steps, k-d trees or full matrices, NumPy.

Subscriptions of libsumo were slower than getters: reading a vehicle took less time, but SUMO's step twice as long. Sparse matrices of
SciPy were slower than full ones for the net's means. A third of the time is reading, the rest the calls of NumPy on short arrays.
"""
import libsumo
import numpy as np
from scipy.spatial import cKDTree

import peer

STATE = 5  # columns: x, y, speed, heading, place on the lane
ALL_PAIRS_UP_TO = 150  # vehicles; of more, k-d trees find near pairs faster


class Net:
    """GraphSAGENet for all pairs at once. A mean over neighbours is a product with a matrix."""

    def __init__(self, weights):
        self.conv = [[weights[f"graphsage.conv{layer}.{part}"].T for part in ("lin_l.weight", "lin_l.bias", "lin_r.weight")]
                     for layer in (1, 2)]
        self.decoder = [weights[f"nn.fc{layer}.{part}"].T for layer in (1, 2) for part in ("weight", "bias")]

    def logits(self, rows, seen, pairs):
        means = np.zeros((len(rows), len(rows)), dtype=np.float32)
        means[seen[:, 0], seen[:, 1]] = means[seen[:, 1], seen[:, 0]] = 1.0
        means /= np.maximum(means.sum(axis=1, keepdims=True), 1.0)
        for from_others, bias, own in self.conv:
            rows = means @ rows @ from_others + bias + rows @ own
        first, first_bias, second, second_bias = self.decoder
        hidden = np.maximum((rows[pairs[:, 0]] * rows[pairs[:, 1]]) @ first + first_bias, 0.0)
        return hidden @ second[:, 0] + second_bias


def near_pairs(places, radius_m, classes):
    """Pairs of rows, left < right, of different classes, not further apart than this at one of the places of all rows."""
    if len(classes) > ALL_PAIRS_UP_TO:
        found = [cKDTree(xy_m, compact_nodes=False, balanced_tree=False).query_pairs(radius_m, output_type="ndarray") for xy_m in places]
        left, right = np.divmod(np.unique(np.concatenate(found) @ (len(classes), 1)), len(classes))
        near = classes[left] != classes[right]
    else:
        across = [np.square(xy_m[:, None, axis] - xy_m[:, axis]) for xy_m in np.asarray(places, dtype=np.float32) for axis in (0, 1)]
        squares = [across[place] + across[place + 1] for place in range(0, len(across), 2)]
        left, right = np.nonzero((np.minimum.reduce(squares) <= radius_m**2) & (classes[:, None] != classes))
        near = left < right
    return np.column_stack((left[near], right[near]))


def distances_m(xy_m, pairs):
    across = xy_m[pairs[:, 0]] - xy_m[pairs[:, 1]]
    return np.hypot(across[:, 0], across[:, 1])


class BestPython:
    def __init__(self, sumo, run):
        self.sumo, self.run = sumo, run
        self.net = Net(peer.read_weights(run.weights))
        self.random = np.random.default_rng(run.seed)
        self.names = ()
        self.classes = np.empty(0, dtype=np.int8)
        self.dark = np.empty(0, dtype=np.int8)  # -1: its chain has not begun
        self.reported_s = np.empty(0)  # not a number: never
        self.reports = np.empty((0, STATE))
        self.lanes = np.empty(0, dtype=object)

    def follow(self, names):
        """Gives every vehicle on the road a row, in SUMO's order."""
        if names == self.names:
            return
        before = {name: row for row, name in enumerate(self.names)}
        row = np.array([before.get(name, -1) for name in names], dtype=int)

        def moved(column, value):
            """Of those who stay; `value` of those who are new."""
            result = np.full((len(names), *column.shape[1:]), value, dtype=column.dtype)
            result[row >= 0] = column[row[row >= 0]]
            return result

        self.reports, self.reported_s = moved(self.reports, 0.0), moved(self.reported_s, np.nan)
        self.lanes, self.dark, self.classes = moved(self.lanes, ""), moved(self.dark, -1), moved(self.classes, peer.HUMAN)
        for new in np.flatnonzero(row < 0):
            self.classes[new] = peer.class_of(self.sumo, names[new])
        self.names = names

    def read(self):
        """State of all vehicles on the road, and their lanes."""
        ask = self.sumo.vehicle
        self.follow(ask.getIDList())
        state = np.empty((len(self.names), STATE))
        state[:, :2] = np.array(list(map(ask.getPosition, self.names))).reshape(-1, 2)
        for column, get in enumerate((ask.getSpeed, ask.getAngle, ask.getLanePosition), 2):
            state[:, column] = list(map(get, self.names))
        return state, list(map(ask.getLaneID, self.names))

    def report(self, state, lanes, now_s):
        if not self.run.reports_at(now_s):
            return
        if self.run.fails:
            anew = (self.dark < 0) | (self.random.random(len(state)) < peer.DRAWN_ANEW)
            self.dark[anew] = self.random.random(np.count_nonzero(anew)) < peer.DARK_SHARE
        heard = self.dark < 1
        self.reports[heard] = state[heard]
        self.reported_s[heard] = now_s
        self.lanes[heard] = np.array(lanes, dtype=object)[heard]

    def step(self, now_s):
        self.report(*self.read(), now_s)
        rows = np.flatnonzero(~np.isnan(self.reported_s))
        if not len(rows):
            return 0
        reports, classes = self.reports[rows], self.classes[rows]
        age_s = now_s - self.reported_s[rows]
        xy_m = peer.places(reports[:, :2], reports[:, 2], reports[:, 3], age_s)
        links = self.links(reports[:, :2], xy_m, age_s, classes, self.dark[rows] < 1)
        if self.run.acts and (classes == peer.EMERGENCY).any():
            peer.make_room(self.sumo, [self.names[row] for row in rows], classes, self.lanes[rows], reports[:, 4], reports[:, 2],
                           links)
        return len(links)

    def links(self, last_m, xy_m, age_s, classes, known):
        """Pairs of rows, left < right: those seen, and of the others those that the net believes."""
        places = [xy_m] if known.all() else [xy_m, last_m]
        pairs = near_pairs(places, peer.RADIUS_M if known.all() else peer.REACH_M, classes)
        both_known = known[pairs].all(axis=1)
        seen = pairs[both_known]
        seen = seen[distances_m(xy_m, seen) < peer.RADIUS_M]
        asked = pairs[~both_known]
        if not len(asked):
            return seen
        believed = self.net.logits(peer.features_of(xy_m, age_s), seen, asked) >= 0.0  # a probability of a half
        return np.concatenate((seen, asked[believed]))


if __name__ == "__main__":
    peer.drive(libsumo, BestPython)
