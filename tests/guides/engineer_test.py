"""The first ten minutes of an engineer: a map, whether it is fit, what priority gains, which signals first, a figure for the council."""
import csv
import gzip
import unittest

from guide import commands, the, type_in
from support import FolderCase

#: Crossings along and across; every second one on the middle street has signals.
ACROSS, ALONG = 3, 6


def town() -> str:
    """A map as OpenStreetMap has it: streets 200 m apart, three signals, a hospital and a fire station."""
    step = 0.002
    text = "<?xml version='1.0' encoding='UTF-8'?>\n<osm version='0.6'>\n"
    places = [(row, column) for row in range(ACROSS) for column in range(ALONG)]
    number = {place: 1 + at for at, place in enumerate(places)}
    for (row, column), node in number.items():
        tag = "<tag k='highway' v='traffic_signals'/>" if row == 1 and column % 2 == 1 else ""
        text += f"<node id='{node}' version='1' lat='{51 + row * step:.6f}' lon='{13 + column * step:.6f}'>{tag}</node>\n"
    for node, kind, row, column in ((100, "hospital", 0, 0), (101, "fire_station", ACROSS - 1, ALONG - 1)):
        text += (f"<node id='{node}' version='1' lat='{51.0001 + row * step:.6f}' lon='{13.0001 + column * step:.6f}'>"
                 f"<tag k='amenity' v='{kind}'/></node>\n")
    streets = [[number[row, column] for column in range(ALONG)] for row in range(ACROSS)]
    streets += [[number[row, column] for row in range(ACROSS)] for column in range(ALONG)]
    for way, nodes in enumerate(streets):
        points = "".join(f"<nd ref='{node}'/>" for node in nodes)
        text += f"<way id='{1000 + way}' version='1'>{points}<tag k='highway' v='secondary'/><tag k='name' v='Street {way}'/></way>\n"
    return text + "</osm>\n"


class EngineerTest(FolderCase):
    def test_from_a_map_to_the_signals_to_equip_and_a_figure(self) -> None:
        (self.folder / "monaco.osm.gz").write_bytes(gzip.compress(town().encode()))
        readme = commands("README.md", "Use it")
        found = type_in(the("scenario import", readme))
        self.assertIn("signals          3", found)
        self.assertRegex(type_in(the("scenario check", readme)), r"preemption [\s\S]*monaco\s+is ")
        verdict = type_in(the("run ./monaco", readme), ("--seeds 10", "--seeds 2")).splitlines()
        self.assertTrue(any(line.startswith("preempt_signals: ") for line in verdict[-12:]), "the verdict stands last")
        equip = the("equip", commands("docs/guides/your-city.md", "Which signals first?"))
        type_in(equip, ("./mine", "./monaco"), ("--budget 5", "--budget 3 --seeds 2 --density 0.3 --out equip"))
        with open("equip/equip.csv", newline="", encoding="utf-8") as file:
            self.assertGreater(len(list(csv.DictReader(file))), 0)
        self.assertIn("</svg>", (self.folder / "equip" / "map.svg").read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main()
