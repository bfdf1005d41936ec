"""The best loop in Python that was found: libsumo in this process, arrays kept between steps, k-d trees of SciPy, the net in NumPy.

What lost against it stands in compare.py's help.
"""
import libsumo
import numpy as np
from scipy.sparse import csr_matrix
from scipy.spatial import cKDTree

import peer

STATE = 5  # columns: x, y, speed, heading, place on the lane


class Net:
    """GraphSAGENet for all pairs at once; the first convolution's mean is a product with a sparse matrix."""

    def __init__(self, weights):
        self.conv = [[weights[f"graphsage.conv{layer}.{part}"].T for part in ("lin_l.weight", "lin_l.bias", "lin_r.weight")]
                     for layer in (1, 2)]
        self.decoder = [weights[f"nn.fc{layer}.{part}"].T for layer in (1, 2) for part in ("weight", "bias")]

    def logits(self, rows, seen, pairs):
        count = len(rows)
        ends = np.concatenate((seen, seen[:, ::-1]))
        sums = csr_matrix((np.ones(len(ends), dtype=np.float32), (ends[:, 1], ends[:, 0])), shape=(count, count))
        share = 1.0 / np.maximum(np.diff(sums.indptr), 1).astype(np.float32)[:, None]
        for from_others, bias, own in self.conv:
            rows = (sums @ rows * share) @ from_others + bias + rows @ own
        first, first_bias, second, second_bias = self.decoder
        hidden = np.maximum((rows[pairs[:, 0]] * rows[pairs[:, 1]]) @ first + first_bias, 0.0)
        return hidden @ second[:, 0] + second_bias


def near_pairs(xy_m, radius_m, classes):
    """Pairs of rows, left < right, of different classes, at most so far apart."""
    tree = cKDTree(xy_m, compact_nodes=False, balanced_tree=False)
    pairs = tree.query_pairs(radius_m, output_type="ndarray")
    return pairs[classes[pairs[:, 0]] != classes[pairs[:, 1]]]


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
        state[:, :2] = np.array([ask.getPosition(name) for name in self.names]).reshape(-1, 2)
        for column, get in enumerate((ask.getSpeed, ask.getAngle, ask.getLanePosition), 2):
            state[:, column] = [get(name) for name in self.names]
        return state, [ask.getLaneID(name) for name in self.names]

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
        if known.all():
            pairs = near_pairs(xy_m, peer.RADIUS_M, classes)
            return pairs[distances_m(xy_m, pairs) < peer.RADIUS_M]
        pairs = near_pairs(xy_m, peer.REACH_M, classes)
        then = near_pairs(last_m, peer.REACH_M, classes)
        codes = np.union1d(pairs[:, 0] * len(xy_m) + pairs[:, 1], then[:, 0] * len(xy_m) + then[:, 1])
        pairs = np.column_stack(np.divmod(codes, len(xy_m)))
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
