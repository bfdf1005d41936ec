"""From an import to signals of one's own, by the commands of their guide."""
import re
import unittest
from pathlib import Path

from engineer_test import town
from guide import blocks, commands, type_in
from support import FolderCase

GUIDE = "docs/guides/your-signals.md"


class SignalsTest(FolderCase):
    def name_in_network(self, scenario: str, heading: str, key: str) -> None:
        """Types the line of the guide that sets a key of [network]."""
        (line,) = [block for block in blocks(GUIDE, heading) if block.startswith(key)]
        file = Path(scenario, "scenario.toml")
        text = file.read_text(encoding="utf-8")
        self.assertEqual(text.count("[network]\n"), 1)
        file.write_text(text.replace("[network]\n", f"[network]\n{line}"), encoding="utf-8")

    def test_from_an_import_to_programs_parameters_and_what_they_give(self) -> None:
        self.write("monaco.osm", town())
        type_in("clearway scenario import monaco.osm --name monaco")
        (signals,) = commands(GUIDE, "List the signals")
        self.assertIn("  90  3 ", type_in(signals))
        self.assertIn("</svg>", Path("signals.svg").read_text(encoding="utf-8"))

        programs = "".join(re.findall(r"<tlLogic.*?</tlLogic>", Path("monaco/network.net.xml").read_text(encoding="utf-8"), re.DOTALL))
        self.write("monaco/programs.add.xml", "<additional>" + programs.replace('programID="0"', 'programID="mine"').replace('duration="3"', 'duration="4"') + "</additional>")
        self.name_in_network("monaco", "Enter your programs", "additional")
        self.assertIn("  92  4 ", type_in(signals))

        file = Path("monaco/preemption.csv")
        head, *rows = file.read_text(encoding="utf-8").splitlines()
        column = head.split(",").index("minimum_green_s")
        cells = [row.split(",") for row in rows]
        for row in cells:
            row[column] = "7"
        file.write_text("\n".join([head, *map(",".join, cells)]) + "\n", encoding="utf-8")
        self.assertEqual(type_in(signals).count("    set  minimum_green_s=7\n"), 3)

        init, out = commands(GUIDE, "Set preemption parameters")
        type_in(init)
        type_in(out)
        self.name_in_network("my-city", "Set preemption parameters", "preemption")
        type_in("clearway scenario signals ./my-city")

        equip, run = commands(GUIDE, "Which to equip first")
        type_in(equip, ("--budget 5", "--budget 5 --dry-run"))
        self.assertIn("first-three", type_in(run, ("A,B,C", "#1,#2,#3"), ("--seed 2", "--seed 2 --no-solo")))


if __name__ == "__main__":
    unittest.main()
