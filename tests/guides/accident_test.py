"""An accident on a map, by the commands of its guide: from a blocked road to what a better way would have saved."""
import csv
import unittest
from pathlib import Path

from guide import blocks, commands, run_folder, type_in
from support import FolderCase

GUIDE = "docs/guides/accident.md"


class AccidentTest(FolderCase):
    def rows(self, name: str) -> list[dict[str, str]]:
        with open(run_folder(name) / "runs.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_from_a_blocked_road_to_the_regret_of_a_way(self) -> None:
        init, check = commands(GUIDE, "1. The scenario")[0], commands(GUIDE, "1. The scenario")[-1]
        type_in(init)
        incident = next(block for block in blocks(GUIDE, "1. The scenario") if "[[incident]]" in block)
        file = Path("my-city/scenario.toml")
        file.write_text(file.read_text(encoding="utf-8") + "\n" + incident, encoding="utf-8")
        self.assertIn("my-city is ", type_in(check))
        compare = commands(GUIDE, "2. The comparison")
        self.assertEqual(len(compare), 5)
        self.assertIn("8 cells, 160 runs", type_in(compare[0] + " --dry-run"))
        type_in(compare[1], ("--seeds 10", "--seeds 1 --no-solo --out runs/navigate"))
        found = {row["condition"]: row for row in self.rows("navigate")}
        self.assertEqual(set(found), {"baseline", "navigate"})
        type_in(compare[3], ("--seeds 1", "--seeds 1 --no-solo"))
        self.assertTrue(Path(type_in(compare[4]).strip()).exists())
        called = next(block for block in blocks(GUIDE, "3. Who is sent") if "[[call]]" in block)
        file.write_text(file.read_text(encoding="utf-8") + "\n" + called.replace('"..."', '"-142575694#2"'), encoding="utf-8")
        self.assertIn("my-city is fit for a study", type_in(check))
        sent = commands(GUIDE, "3. Who is sent")
        self.assertEqual(len(sent), 2)
        type_in(sent[1], ("--seeds 10", "--seeds 1 --no-solo --out runs/sent"))
        answered = next(row for row in self.rows("sent") if row["condition"] != "baseline")
        self.assertEqual(answered["units_sent"], "2")
        self.assertGreater(int(answered["unit_decisions"]), 0, "two stations: there is one that was not sent")
        tried = commands(GUIDE, "4. What a better way would have saved")[0]
        type_in(tried, ("--seeds 5", "--seeds 1 --no-solo --out runs/tried"), ("ways_tried=8", "ways_tried=2"))
        chosen = next(row for row in self.rows("tried") if row["condition"] != "baseline")
        self.assertGreater(int(chosen["way_decisions"]), 0)
        self.assertGreaterEqual(float(chosen["way_regret_s"]), 0.0)


if __name__ == "__main__":
    unittest.main()
