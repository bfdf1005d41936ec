"""A study and its picture: what policies gain, with their intervals. `python3 study_with_plot.py [FOLDER] [SEEDS]`

In the dense variant, because an EV that finds a green light and an empty lane has nothing to gain in some replications of the standard one.
Draws with matplotlib where it is installed (study.png in the folder), and in letters otherwise.
"""
import sys
from pathlib import Path

import clearway

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "runs/plot")
seeds = int(sys.argv[2]) if len(sys.argv) > 2 else 5
conditions = [clearway.Condition(name, policy=policy) for name, policy in (
    ("signals", "preempt_signals"), ("lanes", "clear_lane"), ("mine", f"{Path(__file__).parent / 'yield_policy.py'}:Yield"))]
results = clearway.run("intersection", conditions, seeds=seeds, out=folder, variant="dense")
differences = results.paired_differences("emergency_travel_time_s")

try:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
except ImportError:
    for one in differences:
        print(f"{one.condition:>8} {one.difference:+7.1f} s {'#' * round(max(0.0, -one.difference))}")
else:
    low = [one.difference - one.interval_95[0] if one.interval_95 else 0.0 for one in differences]
    pyplot.errorbar([one.difference for one in differences], [one.condition for one in differences], xerr=low, fmt="o")
    pyplot.axvline(0.0)
    pyplot.xlabel("EV travel time against the baseline, s")
    pyplot.savefig(folder / "study.png")
    print(folder / "study.png")
