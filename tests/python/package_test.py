"""Import, installation and what is said when something is missing."""
import ast
import importlib.util
import inspect
import json
import os
import pydoc
import re
import subprocess
import sys
import textwrap
import unittest

import clearway
import numpy as np
from clearway import _program
from support import FolderCase, PROGRAMS, SOURCE, program, python


class ImportTest(FolderCase):
    def test_loads_no_heavy_package(self) -> None:
        ended = python("import clearway, sys; from clearway import *; "
                       "print([name for name in ('torch', 'gymnasium', 'pettingzoo', 'pandas', 'h5py') if name in sys.modules])")
        self.assertEqual((ended.stdout.strip(), ended.stderr), ("[]", ""))

    def test_lists_every_public_name_with_a_docstring(self) -> None:
        for name in clearway.__all__:
            self.assertTrue(hasattr(clearway, name), name)
            if name != "__version__":
                self.assertGreater(len(getattr(clearway, name).__doc__ or ""), 30, name)

    def test_help_of_a_class_says_every_public_attribute(self) -> None:
        """Those that methods set, fields and annotations: none of them would be in ``help()`` without its docstring."""
        classes = [value for value in (getattr(clearway, name) for name in clearway.__all__) if isinstance(value, type)]
        self.assertGreater(len(classes), 20)
        for kind in classes:
            (tree,) = ast.parse(textwrap.dedent(inspect.getsource(kind))).body
            names = {node.target.id for node in tree.body if isinstance(node, ast.AnnAssign)} | set(getattr(kind, "_names", ()))
            names |= {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store)
                      and isinstance(node.value, ast.Name) and node.value.id == "self"}
            told = set(re.findall(r"``(\w+)", kind.__doc__))
            missing = {name for name in names if not name.startswith("_")} - told - {"metadata", "np_random", "np_random_seed"}
            self.assertEqual(missing, set(), kind.__name__)
            self.assertIn(kind.__doc__.splitlines()[0], pydoc.render_doc(kind, renderer=pydoc.plaintext))

    def test_a_misspelt_attribute_names_the_nearest_and_all(self) -> None:
        network = clearway.Network({"lane_ids": [], "edges": [], "onward": [], "signals": [],
                                    "lanes": {"edge": [], "length_m": [], "speed_limit_mps": [], "number": []}})
        approach = clearway.Approach(0, 1.0, [], [])
        table = clearway.Table({"collisions": np.zeros(1)})
        for thing, wrong, says in ((network, "lane_lengths_m", "Network has no 'lane_lengths_m'. Did you mean 'lane_length_m' or "),
                                   (network, "signals", "Did you mean 'signal_ids' or 'signal_phases'? It has edge_free_s, "),
                                   (approach, "link", "Approach has no 'link'. Did you mean 'links' or 'own_links'? It has distance_m, "),
                                   (table, "collisions", "Table has no 'collisions': a column is table['collisions']"),
                                   (clearway.Condition("a"), "polcy", "Condition has no 'polcy'. Did you mean 'policy'? It has bluelight, "),
                                   (table, "wher", "Did you mean 'where'? It has get, head, "),
                                   (clearway.Lease, "green", "Lease has no 'green'. Did you mean 'hold_green' or 'adjust_green'? It has adjust_green, "),
                                   (clearway.Lease, "set_speed", "hold_lane, pass_red, pull_aside, stop_at_line, take_route"),
                                   (table, "_nothing", "Table has no '_nothing'")):
            message = self.message_of(AttributeError, lambda: getattr(thing, wrong))
            self.assertIn(says, message)
        self.assertTrue(repr(network).startswith("<Network: edge_free_s, "))

        class Broken(_program.Told):
            @property
            def whole(self) -> int:
                return self.part
        self.assertIn("has no 'part'", self.message_of(AttributeError, lambda: Broken().whole))

    def test_says_what_it_has_when_a_name_is_wrong(self) -> None:
        self.assertIn("no 'conditions'. Did you mean 'Condition'? It has Approach, ",
                      self.message_of(AttributeError, lambda: clearway.conditions))
        self.assertEqual("clearway has no '_nothing'", self.message_of(AttributeError, lambda: clearway._nothing))

    def test_has_a_module_that_says_what_torchscript_is_given(self) -> None:
        ended = python("import clearway; help(clearway.torchscript)")
        self.assertIn("float32[vehicles, 8]", ended.stdout)

    def test_has_the_modules_whose_constants_its_help_names(self) -> None:
        ended = python("import clearway; print(clearway.parts.NO_LANE, clearway.recording.NONE)")
        self.assertEqual((ended.stdout, ended.stderr), ("4294967295 4294967295\n", ""))

    def test_says_which_python_lacks_numpy(self) -> None:
        bare = self.folder / "bare"
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(bare)], check=True)
        ended = python("import clearway", str(bare / "bin" / "python3"))
        self.assertEqual(ended.returncode, 1)
        self.assertIn(f"clearway needs numpy, which {bare}/bin/python3 does not have", ended.stderr)

    def test_says_where_programs_were_looked_for(self) -> None:
        ended = python("import clearway; clearway.open('runs')", CLEARWAY_PROGRAMS=str(self.folder))
        self.assertIn(f"EnvironmentFault: Clearway's programs are not in {self.folder}", ended.stderr)

    def test_has_the_version_of_the_programs(self) -> None:
        self.assertEqual(program("--version").split()[1], clearway.__version__)


# As much of gymnasium as keeps names; a name that is given twice fails.
REGISTRATION = """
import json, sys, types
registration = types.ModuleType("gymnasium.envs.registration")
registration.registry = {}
def register(id, **given):
    assert id not in registration.registry
    registration.registry[id] = given
registration.register = register
sys.modules["gymnasium"] = types.ModuleType("gymnasium")
sys.modules["gymnasium.envs.registration"] = registration
"""


class InstallTest(FolderCase):
    code = "import clearway, clearway._program as p; print(clearway.__file__, p.programs())"

    def test_into_a_folder(self) -> None:
        program("python", "--to", "packages")
        program("python", "--to", "packages")  # again, over the first
        ended = python(self.code, PYTHONPATH=str(self.folder / "packages"), CLEARWAY_PROGRAMS="")
        self.assertEqual(ended.stdout.split(), [str(self.folder / "packages/clearway/__init__.py"), str(PROGRAMS)], ended.stderr)
        self.assertEqual(sorted(file.name for file in (self.folder / "packages").iterdir()),
                         ["clearway", f"clearway-{clearway.__version__}.dist-info"])

    def test_pip_installs_it_without_a_network(self) -> None:
        if importlib.util.find_spec("pip") is None:
            self.skipTest("no pip (Debian: python3-pip)")
        pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--no-cache-dir"]
        made = subprocess.run([*pip, "wheel", "--no-index", "--no-deps", "--wheel-dir", "wheels", str(SOURCE / "python")],
                              capture_output=True, text=True, check=False)
        self.assertEqual(made.returncode, 0, made.stdout + made.stderr)
        ended = subprocess.run([*pip, "install", "--no-index", "--no-deps", "--target", "packages",
                                f"wheels/clearway-{clearway.__version__}-py3-none-any.whl"], capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        packages = str(self.folder / "packages")
        ended = python(self.code, PYTHONPATH=packages, CLEARWAY_PROGRAMS="")
        self.assertEqual(ended.stdout.split(), [f"{packages}/clearway/__init__.py", str(PROGRAMS)], ended.stderr)
        told = "import importlib.metadata as m; one = m.metadata('clearway'); print(one['License'], one.get_all('Provides-Extra'))"
        self.assertEqual(python(told, PYTHONPATH=packages).stdout, "Apache-2.0 ['tables', 'recordings', 'learning']\n")

    def test_gymnasium_is_told_a_name_for_each_scenario(self) -> None:
        program("python", "--to", "packages")
        scenarios = sorted(file.parent.name for file in SOURCE.glob("scenarios/*/scenario.toml"))
        for way in ("import clearway",
                    "import importlib.metadata as metadata\n"  # as gymnasium does at its own import
                    "[point.load()() for point in metadata.entry_points(group='gymnasium.envs') if point.name == 'Clearway']"):
            ended = python(REGISTRATION + way + "\nprint(json.dumps(registration.registry))", PYTHONPATH=str(self.folder / "packages"))
            self.assertEqual((ended.returncode, ended.stderr), (0, ""))
            self.assertEqual(json.loads(ended.stdout), {
                f"Clearway/{name}-v0": {"entry_point": "clearway.environment:Env", "kwargs": {"scenario": name}} for name in scenarios})

    def test_into_a_virtual_environment_that_is_made(self) -> None:
        program("python", "--venv", "mine")
        ended = python(self.code, str(self.folder / "mine/bin/python3"), PYTHONPATH="", CLEARWAY_PROGRAMS="")
        self.assertEqual(ended.stdout.split()[1:], [str(PROGRAMS)], ended.stderr)
        self.assertTrue(ended.stdout.startswith(str(self.folder / "mine/lib")))

    def installed(self, *words: str, limit: str = "true") -> subprocess.CompletedProcess:
        """`clearway python --to packages`, under a limit of the shell."""
        return subprocess.run(["bash", "-c", f'{limit}; exec "$@"', "bash", str(PROGRAMS / "clearway"), "python", *words, "--to",
                               "packages"], capture_output=True, text=True, check=False)

    def files(self) -> dict[str, str]:
        return {str(path.relative_to(self.folder)): path.read_text() for path in self.folder.rglob("*") if path.is_file()}

    def test_leaves_what_is_not_an_installation_as_it_is(self) -> None:
        (self.folder / "packages").mkdir()
        (self.folder / "elsewhere").mkdir()
        for name in ("_installed.json", "RECORD"):  # as in an installation, but only a link leads there
            self.write(f"elsewhere/{name}", "clearway/_installed.json,,")
        theirs = {"a clone": lambda place: (place.mkdir(), (place / "thesis.txt").write_text("years")),
                  "a file": lambda place: place.write_text("mine"),
                  "a link": lambda place: place.symlink_to("../elsewhere"),
                  "a link to nothing": lambda place: place.symlink_to("nowhere")}
        for name in ("clearway", f"clearway-{clearway.__version__}.dist-info"):
            for title, make in theirs.items():
                with self.subTest(name=name, place=title):
                    place = self.folder / "packages" / name
                    make(place)
                    before = self.files()
                    for _ in range(2):
                        ended = self.installed()
                        self.assertEqual(ended.returncode, 3, ended.stdout)
                        self.assertIn(f"packages/{name}: is not an installation of Clearway and stays as it is", ended.stderr)
                        self.assertIn("--to", ended.stderr)
                    self.assertEqual(self.files(), before)
                    self.assertEqual(os.listdir("packages"), [name])
                    subprocess.run(["rm", "-r", str(place)], check=True)

    def test_removes_its_own_records_and_leftovers_alone(self) -> None:
        program("python", "--to", "packages")
        packages = self.folder / "packages"
        own = packages / f"clearway-{clearway.__version__}.dist-info"
        own.rename(packages / "clearway-0.0.1.dist-info")  # of an earlier version
        kept = ["clearway-tools-1.dist-info", ".clearway.new", f".clearway.{os.getpid()}.part"]
        for name in [*kept, ".clearway.2147483647.part"]:
            (packages / name).mkdir()
            (packages / name / "mine").write_text("kept")
        program("python", "--to", "packages")
        self.assertEqual(sorted(os.listdir(packages)), sorted(["clearway", own.name, *kept]))

    def test_many_at_once_end_well(self) -> None:
        calls = [subprocess.Popen([str(PROGRAMS / "clearway"), "python", "--to", "packages"], stdout=subprocess.DEVNULL,
                                  stderr=subprocess.PIPE, text=True) for _ in range(6)]
        self.assertEqual([(call.communicate()[1], call.returncode) for call in calls], [("", 0)] * 6)
        self.assertEqual(sorted(os.listdir("packages")), ["clearway", f"clearway-{clearway.__version__}.dist-info"])

    def test_a_limit_of_files_is_told_and_an_earlier_installation_stays(self) -> None:
        program("python", "--to", "packages")
        before = self.files()
        ended = self.installed(limit="ulimit -f 10")
        self.assertEqual(ended.returncode, 4)
        self.assertEqual(ended.stderr, "clearway: packages: cannot be written: File too large. Raise the limit of `ulimit -f` and give "
                                       "the same command again\n")
        self.assertEqual(self.files(), before)

    def test_refuses_a_program_that_is_no_python(self) -> None:
        for other in ("/bin/true", "/bin/echo", "/bin/false"):
            ended = self.installed("--python", other)
            self.assertEqual(ended.returncode, 3, other)
            self.assertIn(f"--python: {other} is no Python 3", ended.stderr)

    def test_says_what_cannot_be_written(self) -> None:
        self.write("taken", "")
        ended = subprocess.run([str(PROGRAMS / "clearway"), "python", "--to", "taken"], capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 4)
        self.assertIn("taken: cannot be written", ended.stderr)

    def test_refuses_a_python_without_numpy_or_none_at_all(self) -> None:
        ended = subprocess.run([str(PROGRAMS / "clearway"), "python", "--python", "/no/python3"], capture_output=True, text=True,
                               check=False)
        self.assertEqual(ended.returncode, 4)
        self.assertIn("/no/python3: cannot be started", ended.stderr)


if __name__ == "__main__":
    unittest.main()
