"""Policies in Python for python_policy_test.cpp: the fastest way by believed times, and these times themselves."""
import heapq
import math

from clearway import Lease


class FastestWay:
    """As ``navigate``, with times that stay as they are now: it changes for a gain of 10 s."""

    def act(self, belief):
        times_s, leases = belief.edge_times_s.tolist(), []
        for ev in belief.emergency_vehicles:
            route = ev.route.tolist()
            way = self.way(belief.network.onward, times_s, route[0], route[-1])
            if self.time_s(times_s, way) < self.time_s(times_s, route) - 10.0:
                leases.append(Lease.take_route(ev, way, serves=ev, lasting_s=5.0, reason="another way is faster"))
        return leases

    @staticmethod
    def time_s(times_s, way):
        return sum(times_s[edge] for edge in way[1:])

    @staticmethod
    def way(onward, times_s, start, end):
        best_s, before, queue = {start: 0.0}, {}, [(0.0, start)]
        while queue:
            now_s, edge = heapq.heappop(queue)
            if edge == end:
                break
            for other in onward[edge]:
                then_s = now_s + times_s[other]
                if then_s < best_s.get(other, math.inf):
                    best_s[other], before[other] = then_s, edge
                    heapq.heappush(queue, (then_s, other))
        way = [end]
        while way[-1] != start:
            way.append(before[way[-1]])
        return way[::-1]


class Told:
    """Says the time of each edge, in order, as the reason of a lease."""

    def act(self, belief):
        assert len(belief.edge_times_s) == len(belief.network.edge_ids)
        (ev,) = belief.emergency_vehicles
        return [Lease.hold_lane(ev, reason=repr(time_s)) for time_s in belief.edge_times_s.tolist()]
