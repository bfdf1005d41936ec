"""What the trained policy looks at, from an environment's observation and, the same numbers, from a belief."""
import numpy as np

GREEN, YELLOW = "GgoO", "yYu"
#: Decisions, of 0.5 s, for which a choice is kept.
KEPT = 8


def features_of_observation(observation):
    """For a batch of observations, the first signal alone: ``float32[n, 5 + links + phases]``."""
    vehicle, signal = observation["emergency"], observation["signals"][:, 0]
    near = np.stack([vehicle[:, 1] / 20.0, vehicle[:, 2] / 20.0, signal[:, 0], signal[:, 1] / 300.0, signal[:, 2]], axis=1)
    return np.concatenate([near, observation["signal_states"][:, 0] / 3.0, observation["signal_phases"][:, 0]], axis=1).astype(np.float32)


def features_of_belief(belief, ev):
    """The same for one emergency vehicle of a belief, or for none."""
    letters = belief.signal_state(0)
    colours = np.array([3 if one in GREEN else 2 if one in YELLOW else 1 for one in letters], dtype=np.float32)
    ahead = [] if ev is None else [one for one in ev.approaches if one.signal == 0 and one.distance_m <= 300.0]
    near = [0.0, 0.0, 0.0, 1.0, 0.0]
    phases = green_phases(belief.network, 0)
    served = np.zeros(len(phases), dtype=np.float32)
    if ev is not None:
        near[:2] = ev.speed_mps / 20.0, ev.allowed_speed_mps / 20.0
    if ahead:
        share = np.mean([letters[link] in GREEN for link in ahead[0].own_links])
        near[2:] = 1.0, ahead[0].distance_m / 300.0, share
        served[:] = [np.mean([link in links for link in ahead[0].own_links]) for links in phases]
    return np.concatenate([np.array(near, dtype=np.float32), colours / 3.0, served]).astype(np.float32)


def green_phases(network, signal):
    """Links that are green in each green phase of a signal's own program, as the environment numbers them."""
    return [[link for link, letter in enumerate(state) if letter in GREEN] for state in network.signal_phases[signal]
            if any(letter in GREEN for letter in state) and not any(letter in "yY" for letter in state)]
