"""What both Python peers share: the run that compare.py describes, outages, the net's parameters, the policy and the clock.

    /usr/bin/python3 getters_loop.py RUN.json      compare.py writes RUN.json and reads the line of JSON that is printed

RUN.json: SUMO's arguments, when the timed part begins and ends, the file of weights, and whether sensors fail and the policy acts.
Choices that Clearway makes otherwise, all of which save a peer work: reports go straight on between two rounds, not along the route;
the policy looks along one edge; nothing is measured, and no signal is read.
"""
import dataclasses
import json
import pathlib
import sys
import time

import numpy as np

RADIUS_M = 50.0  # of links: loop.link_radius_m
REACH_M = 120.0  # of pairs that are judged: src/prediction/candidates.hpp
LINKED = 0.5  # least probability of a predicted link
HUMAN, AUTOMATED, EMERGENCY = range(3)
CLASSES = {"human": HUMAN, "automated": AUTOMATED, "emergency": EMERGENCY}

# Clearway's B10 (docs/reference/sensing.md): reports at 1 Hz; a chain that is drawn anew with this probability, and then dark with that.
REPORT_EVERY_S = 1.0
DARK_SHARE = 0.3
DRAWN_ANEW = REPORT_EVERY_S / 10.0 / (1.0 - DARK_SHARE)

# Features of `graphsage_corrected` (src/prediction/comparison/features.hpp).
AMPLITUDE = 3.0
WAVE_NUMBER = 2.0 * np.pi / 400.0
AGE_SCALE_S = 10.0


@dataclasses.dataclass(frozen=True)
class Run:
    arguments: list[str]
    begin_s: float
    end_s: float
    weights: str
    fails: bool  # sensors have outages; otherwise every step reports every vehicle
    acts: bool
    seed: int = 1

    def reports_at(self, time_s):
        return not self.fails or abs(time_s / REPORT_EVERY_S - round(time_s / REPORT_EVERY_S)) < 1e-6


def read_weights(file):
    """Tensors of a model file of Clearway by name (src/prediction/weights.hpp)."""
    tensors, name, shape = {}, None, ()
    for line in pathlib.Path(file).read_text(encoding="utf-8").splitlines():
        words = line.split()
        if words[0] == "tensor":
            name, shape = words[1], [int(size) for size in words[2:]]
            tensors[name] = []
        elif name and words[0] != "end":
            tensors[name] += [float(word) for word in words]
            if len(tensors[name]) == np.prod(shape):
                tensors[name] = np.array(tensors[name], dtype=np.float32).reshape(shape)
    return tensors


def class_of(sumo, vehicle):
    kind = sumo.vehicle.getTypeID(vehicle)
    return CLASSES[sumo.vehicletype.getParameter(kind, "clearway.class")]


def places(last_xy_m, speed_mps, heading_deg, age_s):
    """Where vehicles are if they kept speed and heading, which SUMO counts clockwise from north."""
    heading = np.radians(heading_deg)
    way_m = speed_mps * age_s
    return last_xy_m + np.column_stack((np.sin(heading) * way_m, np.cos(heading) * way_m))


def features_of(xy_m, age_s):
    x, y = WAVE_NUMBER * xy_m[:, 0], WAVE_NUMBER * xy_m[:, 1]
    waves = AMPLITUDE * np.array((np.cos(x), np.sin(x), np.cos(y), np.sin(y)))
    return np.vstack((waves, np.exp(-age_s / AGE_SCALE_S))).T.astype(np.float32)


def make_room(sumo, vehicles, classes, lanes, along_m, speed_mps, links):
    """The dissertation's policy: an EV drives as fast as it may; a linked automated vehicle ahead in its lane leaves it, one beside it
    slows down. `vehicles` and `lanes` are names, all else arrays of rows, `links` pairs of them."""
    for ev in np.flatnonzero(classes == EMERGENCY):
        sumo.vehicle.setSpeed(vehicles[ev], sumo.vehicle.getAllowedSpeed(vehicles[ev]))
        for other in links[(links == ev).any(axis=1)].sum(axis=1) - ev:
            ahead_m = along_m[other] - along_m[ev]
            if classes[other] != AUTOMATED or edge_of(lanes[other]) != edge_of(lanes[ev]) or lanes[ev].startswith(":"):
                continue
            if lanes[other] == lanes[ev] and 0.0 < ahead_m <= RADIUS_M:
                for lane, _, _, _, goes_on, _ in sumo.vehicle.getBestLanes(vehicles[other]):
                    aside = number_of(lane) - number_of(lanes[other])
                    if goes_on and abs(aside) == 1 and sumo.vehicle.couldChangeLane(vehicles[other], aside):
                        sumo.vehicle.changeLane(vehicles[other], number_of(lane), 2.0)
                        break
            elif abs(number_of(lanes[other]) - number_of(lanes[ev])) == 1 and abs(ahead_m) <= 10.0:
                sumo.vehicle.slowDown(vehicles[other], max(0.8 * speed_mps[ev], 5.0), 2.0)


def edge_of(lane):
    return lane.rpartition("_")[0]


def number_of(lane):
    return int(lane.rpartition("_")[2])


def drive(sumo, Loop):
    """Makes the run that the command line names: `Loop(sumo, run).step(time)` after each step of SUMO returns the number of links."""
    run = Run(**json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")))
    sumo.start(["sumo", *run.arguments])
    step_s = sumo.simulation.getDeltaT()
    loop = Loop(sumo, run)
    now_s = simulator_s = beside_s = 0.0
    steps = vehicle_steps = decisions = links = 0
    while now_s < run.end_s - 1e-6 and (now_s < run.begin_s or sumo.simulation.getMinExpectedNumber() > 0):
        is_timed = now_s + step_s > run.begin_s
        begun = time.perf_counter()
        sumo.simulationStep()
        stepped = time.perf_counter()
        now_s = sumo.simulation.getTime()
        if is_timed:
            links += loop.step(now_s)
            simulator_s += stepped - begun
            beside_s += time.perf_counter() - stepped
            decisions += 1
        steps += 1
        vehicle_steps += sumo.vehicle.getIDCount()
    sumo.close()
    print(json.dumps({"simulator_s": simulator_s, "beside_s": beside_s, "vehicles": vehicle_steps / steps, "links": links / decisions,
                      "steps": decisions}))
