"""What the scripts that make tables from `runs.csv` share: runs are dictionaries by replication."""
import math
import statistics

# Two-sided 97.5 % quantiles of Student's t; degrees in between take the next smaller ones.
QUANTILES = {1: 12.706, 2: 4.303, 4: 2.776, 9: 2.262, 14: 2.145, 19: 2.093, 29: 2.045, 59: 2.001}


def values(runs, metric):
    return {number: float(run[metric]) for number, run in runs.items() if run[metric] not in ("", "nan")}


def mean(runs, metric):
    found = values(runs, metric)
    return statistics.mean(found.values()) if found else math.nan


def interval(differences):
    """Mean and ends of its 95 % interval; without ends for a single one."""
    middle = statistics.mean(differences)
    if len(differences) < 2:
        return middle, math.nan, math.nan
    quantile = QUANTILES[max(degrees for degrees in QUANTILES if degrees < len(differences))]
    half = quantile * statistics.stdev(differences) / math.sqrt(len(differences))
    return middle, middle - half, middle + half


def paired_differences(base, runs, metric):
    """Of each replication that both have."""
    one, other = values(base, metric), values(runs, metric)
    return [other[number] - one[number] for number in sorted(set(one) & set(other))]


def difference(base, runs, metric):
    """Mean of the paired differences and ends of its interval; None without pairs."""
    found = paired_differences(base, runs, metric)
    return interval(found) if found else None


def change(base, runs, metric):
    """The same in % of the baseline's mean; None where that cannot be said."""
    one, other = values(base, metric), values(runs, metric)
    both = set(one) & set(other)
    level = statistics.mean(one[number] for number in sorted(both)) if both else 0.0
    if len(both) < 2 or level <= 0.05:
        return None
    return tuple(100 * value / level for value in difference(base, runs, metric))


def shown(ends):
    return "none" if ends is None else "{:+.1f} [{:+.1f}, {:+.1f}]".format(*ends)


def lost(runs):
    """EVs that did not arrive, and all, over the runs."""
    count = sum(int(run["emergency_count"]) for run in runs.values())
    return count - sum(int(run["emergency_arrived"]) for run in runs.values()), count
