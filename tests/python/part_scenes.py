"""Writes what a part in Python is shown, for tests/python/part_scenes.hpp: a line for the network and the columns where they are
new, a line for each scene, and below it one for each decision, with the arrays that have changed."""
import json
from pathlib import Path


def listed(array):
    if array.dtype.kind != "f":
        return array.tolist()
    return [float(f"{value:.7g}") for value in array.tolist()]


def described(network):
    """As src/python/part_process.cpp tells it."""
    lanes = {"edge": network.lane_edge, "number": network.lane_number, "length_m": network.lane_length_m,
             "speed_limit_mps": network.lane_speed_limit_mps}
    return {"edges": list(zip(network.edge_ids, network.edge_lane_count.tolist(), network.edge_is_internal.tolist())),
            "lane_ids": network.lane_ids, "lanes": {name: listed(array) for name, array in lanes.items()},
            "onward": network.onward, "signals": list(zip(network.signal_ids, network.signal_phases))}


class Recorder:
    def __init__(self, into="", scene=""):
        self.file, self.scene, self.before = Path(into), scene, {}

    def note(self, question, **greeting):
        sheet = question._sheet._arrays
        known = self.file.read_text() if self.file.exists() else ""
        lines = []
        if not self.before:
            columns = [[name, kind.str[1:], "", ""] for name, (kind, _, _) in sheet.columns.items()]
            begin = json.dumps({"network": described(question.network), "question": columns, **greeting})
            last = [line for line in known.splitlines() if line.startswith('{"network"')][-1:]
            lines += [begin] if last != [begin] else []
            lines.append(json.dumps({"scene": self.scene}))
        now = {name: listed(sheet[name]) for name in sheet.columns}
        lines.append(json.dumps({name: values for name, values in now.items() if self.before.get(name) != values}, separators=(",", ":")))
        self.before = now
        self.file.write_text(known + "".join(line + "\n" for line in lines))

    def act(self, belief):
        self.note(belief, period_s=self.period_s)
        return []

    def predict(self, observation):
        self.note(observation, link_radius_m=observation.link_radius_m)
        return observation.pair_dead_reckoned_m < observation.link_radius_m
