"""Tests of follow_guide.py."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
FILES = {"registry.cpp": "src/policy/registry.cpp", "policy/keep_distance.hpp": "src/policy/keep_distance.hpp"}
PAGES = ("examples/02_own_policy/README.md", "examples/02_own_policy/keep_distance.hpp")


class FollowGuide(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.tree, self.out = Path(self.folder.name) / "tree", Path(self.folder.name) / "out"
        for file in (*FILES.values(), *PAGES):
            if (ROOT / file).exists():
                self.write(file, (ROOT / file).read_text())

    def write(self, file, text):
        (self.tree / file).parent.mkdir(parents=True, exist_ok=True)
        (self.tree / file).write_text(text)

    def follow(self):
        subprocess.run([sys.executable, HERE / "follow_guide.py", self.tree, self.out], check=True)
        return {name: (self.out / name).read_text() for name in FILES}

    def test_each_line_is_added_once(self):
        once = self.follow()
        self.assertEqual(once["registry.cpp"].count('"keep_distance"'), 1)
        self.assertEqual(once["registry.cpp"].count('#include "policy/keep_distance.hpp"'), 1)
        self.assertIn('    const OwnScenes', (ROOT / PAGES[0]).read_text())
        self.assertRegex((self.out / "scenes.cpp").read_text(), r'(?m)^const OwnScenes \w+\{\{\.policy = "keep_distance",')

    def test_a_tree_that_has_followed_it_stays_as_it_is(self):
        for name, text in self.follow().items():
            self.write(FILES[name], text)
        changed = (self.tree / FILES["policy/keep_distance.hpp"]).read_text().replace("20.0", "30.0")
        self.write(FILES["policy/keep_distance.hpp"], changed)
        for name, text in self.follow().items():
            self.assertEqual(text, (self.tree / FILES[name]).read_text(), name)


if __name__ == "__main__":
    unittest.main()
