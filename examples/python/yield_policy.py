"""A policy in 20 lines: green on arrival, and automated vehicles ahead leave the emergency vehicle's lane.

    clearway run intersection --policy yield_policy.py:Yield
"""
from clearway import Lease, Policy


class Yield(Policy):
    def act(self, belief):
        leases = []
        for ev in belief.emergency_vehicles:
            for approach in ev.approaches:
                if approach.distance_m < 10.0 * max(ev.speed_mps, 5.0):
                    leases.append(Lease.hold_green(approach.signal, approach.links, approach.own_links, serves=ev, lasting_s=1.0,
                                                   reason="arrives"))
            for row, (outward, inward) in zip(ev.ahead(within_m=150.0), ev.ahead_lanes):
                if belief.vehicles.lane[row] == ev.lane and (outward or inward):
                    number = int(belief.vehicles.lane_number[row])
                    target = number - 1 if outward else number + 1
                    leases.append(Lease.change_lane(belief.vehicles.key[row], target, serves=ev, reason="leaves the lane"))
        return leases
