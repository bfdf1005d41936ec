"""Cuts a window out of a SUMO network and its traffic, for scripts/windows. A window has whole junctions with all their roads, each
as in the original, with its signals; other ends of these roads become dead ends.
"""
import collections
import dataclasses
import gzip
import math
import xml.etree.ElementTree as ElementTree

CRAWL_MPS = 0.5  # the least limit of a road that leads out
STOPS = ("busStop", "trainStop", "parkingArea", "containerStop")


def parse(path):
    opened = gzip.open if str(path).endswith(".gz") else open
    with opened(path, "rb") as file:
        return ElementTree.parse(file).getroot()


def write(root, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


class Network:
    """Roads, junctions and signals of a .net.xml."""

    def __init__(self, path):
        self.root = parse(path)
        roads = [edge for edge in self.root.iter("edge") if edge.get("from")]
        self.ends = {edge.get("id"): (edge.get("from"), edge.get("to")) for edge in roads}
        self.shapes = {edge.get("id"): edge.find("lane").get("shape") for edge in roads}
        self.lanes = {edge.get("id"): edge.findall("lane") for edge in roads}
        self.lengths = {edge.get("id"): float(edge.find("lane").get("length")) for edge in roads}
        self.junctions = {row.get("id"): row for row in self.root.iter("junction") if row.get("type") != "internal"}
        self.signals = collections.defaultdict(set)
        for row in self.root.iter("connection"):
            if row.get("tl") and row.get("from") in self.ends:
                self.signals[row.get("tl")].add(self.ends[row.get("from")][1])

    def length(self, way):
        return sum(map(self.lengths.get, way))

    def signals_on(self, way):
        passed = {self.ends[edge][1] for edge in way[:-1]}
        return sum(bool(passed & junctions) for junctions in self.signals.values())


@dataclasses.dataclass
class Window:
    """Junctions that are kept with all their roads, these roads, and the signals."""
    inner: set
    roads: set
    signals: set

    @staticmethod
    def around(network, way, margin_m):
        shapes = [[tuple(map(float, point.split(",")[:2])) for point in network.shapes[edge].split()] for edge in way]
        pieces = [piece for shape in shapes for piece in zip(shape, shape[1:])]
        inner = {name for edge in way for name in network.ends[edge]}
        inner |= {name for name, row in network.junctions.items()
                  if any(distance((float(row.get("x")), float(row.get("y"))), *piece) <= margin_m for piece in pieces)}
        signals = {name for name, junctions in network.signals.items() if junctions & inner}
        inner |= {junction for name in signals for junction in network.signals[name]}
        return Window(inner, {edge for edge, ends in network.ends.items() if inner & set(ends)}, signals)

    def network(self, network):
        """The .net.xml of the window. What is kept is as in the original; junctions beyond become dead ends."""
        kept = ElementTree.Element("net", network.root.attrib)
        border = {end for edge in self.roads for end in network.ends[edge]} - self.inner
        for row in network.root:
            if row.tag == "junction" and row.get("id") in border:
                lanes = [lane for lane in row.get("incLanes").split() if edge_of(lane) in self.roads]
                kept.append(ElementTree.Element("junction", {**row.attrib, "type": "dead_end", "incLanes": " ".join(lanes),
                                                             "intLanes": ""}))
            elif self.has(row, network):
                kept.append(row)
        return kept

    def has(self, row, network):
        name = row.get("id") if row.tag in ("edge", "junction") else row.get("from", "")
        if name.startswith(":"):
            return name[1:].rsplit("_", 2 if row.tag == "junction" else 1)[0] in self.inner
        return {"edge": lambda: name in self.roads, "junction": lambda: name in self.inner,
                "connection": lambda: network.ends[name][1] in self.inner, "tlLogic": lambda: row.get("id") in self.signals,
                "roundabout": lambda: set(row.get("nodes").split()) <= self.inner}.get(row.tag, lambda: True)()

    def pieces(self, network, way):
        """[first, end) of each stretch of a way that lies in the window."""
        first = None
        for index, edge in enumerate([*way, None]):
            if first is not None and (edge not in self.roads or network.ends[edge][0] not in self.inner):
                yield first, index
                first = None
            if first is None and edge in self.roads:
                first = index


def distance(point, start, end):
    """From a point to a stretch."""
    along = (end[0] - start[0], end[1] - start[1])
    share = sum((p - s) * a for p, s, a in zip(point, start, along)) / (sum(a * a for a in along) or 1.0)
    return math.dist(point, [s + min(1.0, max(0.0, share)) * a for s, a in zip(start, along)])


def edge_of(lane):
    return lane.rsplit("_", 1)[0]


def recorded_ways(path):
    """Vehicle -> edges of its way, and when it left each (negative: not yet)."""
    found = {}
    for _, row in ElementTree.iterparse(path):
        if row.tag == "vehicle":
            route = list(row.iter("route"))[-1]
            found[row.get("id")] = (route.get("edges").split(), [float(time) for time in route.get("exitTimes").split()])
            row.clear()
    return found


def exit_speeds(speeds, window, network):
    """Speed signs on the roads that lead out of the window: the mean speed of the background, or the limit where nobody drove."""
    for edge in sorted(window.roads):
        if network.ends[edge][1] in window.inner:
            continue
        limit_mps = max(float(lane.get("speed")) for lane in network.lanes[edge])
        lanes = " ".join(lane.get("id") for lane in network.lanes[edge])
        sign = ElementTree.Element("variableSpeedSign", id=f"exit.{edge}", lanes=lanes)
        for begin_s, of_edges in speeds:
            speed_mps = min(limit_mps, max(CRAWL_MPS, of_edges.get(edge, limit_mps)))
            ElementTree.SubElement(sign, "step", time=f"{begin_s:g}", speed=f"{speed_mps:.2f}")
        yield sign


def cut_routes(vehicles, ways, stop_edges, window, network):
    """Vehicles of the window. One that comes to it again is another vehicle; one that begins there departs as before."""
    found = []
    for vehicle in vehicles:
        own = vehicle.find("route").get("edges").split()
        way, left = ways.get(vehicle.get("id"), (own, []))
        for number, (first, end) in enumerate(window.pieces(network, way)):
            if first and (len(left) < first or left[first - 1] < 0):
                continue  # never came there
            part = ElementTree.Element("vehicle", vehicle.attrib)
            if number:
                part.set("id", f"{vehicle.get('id')}@{number}")
            if first:
                part.attrib.pop("departPos", None)
                part.attrib.update(depart=f"{left[first - 1]:.2f}", departLane="best", departSpeed="max")
            if end < len(way):
                for name in ("arrivalPos", "arrivalLane", "arrivalSpeed"):
                    part.attrib.pop(name, None)
            ElementTree.SubElement(part, "route", edges=" ".join(way[first:end]))
            for stop in vehicle.iter("stop"):
                place = [edge_of(stop.get("lane"))] if stop.get("lane") else [stop_edges.get(stop.get(tag)) for tag in STOPS]
                if set(place) & set(way[first:end]):
                    part.append(stop)
            found.append(part)
    root = ElementTree.Element("routes")
    root.extend(sorted(found, key=lambda part: float(part.get("depart"))))
    return root
