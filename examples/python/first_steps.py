"""First steps: run, read, compare. `python3 first_steps.py [FOLDER]`"""
import sys

import clearway

folder = sys.argv[1] if len(sys.argv) > 1 else "runs/first-steps"
results = clearway.run("intersection", ["corridor"], seeds=3, out=folder)  # a baseline is added
runs = results.runs
for condition in ("baseline", "corridor"):
    times = runs.where(condition=condition)["emergency_travel_time_s"]
    print(f"{condition}: EV travel times {times.round(1).tolist()} s")
print(results.paired_difference("emergency_travel_time_s", "corridor"))
